//! What a robot and its paths are read from.

use crate::arrays::Doubles;
use crate::fault::Fault;
use d2m_robot::{Interpolation, RobotError, Trajectory, TrajectoryPoint};
use pyo3::prelude::*;
use std::path::PathBuf;

impl From<RobotError> for Fault {
    fn from(error: RobotError) -> Self {
        let fault = Self::new(error.to_string());
        match &error {
            RobotError::Path { place, .. } => match crate::fault::first_index(place) {
                Some(index) => fault.at(index),
                None => fault,
            },
            RobotError::Xml { line, .. }
            | RobotError::MeshFile { line, .. }
            | RobotError::Shape { line, .. } => fault.at(*line as usize),
            _ => fault,
        }
    }
}

/// Where a text is.
pub(crate) enum Source {
    File(PathBuf),
    Text {
        /// Of the file that it was, for messages and for the meshes beside it.
        file: String,
        text: String,
    },
}

impl Source {
    /// A text that begins as XML does, which is called `name`, or a path.
    pub(crate) fn new(any: &Bound<'_, PyAny>, name: &str) -> PyResult<Self> {
        match any.extract::<String>() {
            Ok(text) if text.trim_start_matches('\u{feff}').trim_start().starts_with('<') => {
                Ok(Self::Text { file: name.to_owned(), text })
            }
            _ => Ok(Self::File(any.extract()?)),
        }
    }
}

/// Of times, positions, velocities and accelerations.
pub(crate) fn path(
    [times, positions, velocities, accelerations]: [Option<&Bound<'_, PyAny>>; 4],
    joints: Vec<String>,
) -> PyResult<Trajectory> {
    let read = |any: Option<&Bound<'_, PyAny>>, name: &str, shape: &[Option<usize>]| {
        any.map(|any| Ok::<_, PyErr>(Doubles::new(any, name, shape)?.slice().to_vec())).transpose()
    };
    let times = read(times, "times", &[None])?.unwrap_or_default();
    let shape = [Some(times.len()), Some(joints.len())];
    let positions = read(positions, "positions", &shape)?.unwrap_or_default();
    let velocities = read(velocities, "velocities", &shape)?;
    let accelerations = read(accelerations, "accelerations", &shape)?;
    let width = joints.len();
    let row = |all: &[f64], point: usize| all[point * width..(point + 1) * width].to_vec();
    let point = |(place, &time): (usize, &f64)| {
        let mut point = TrajectoryPoint::new(time, row(&positions, place));
        if let Some(velocities) = &velocities {
            point = point.with_velocities(row(velocities, place));
        }
        if let Some(accelerations) = &accelerations {
            point = point.with_accelerations(row(accelerations, place));
        }
        point
    };
    let interpolation = match (&velocities, &accelerations) {
        (_, Some(_)) => Interpolation::Quintic,
        (Some(_), None) => Interpolation::Cubic,
        (None, None) => Interpolation::Linear,
    };
    let points = times.iter().enumerate().map(point).collect();
    Ok(Trajectory::new(joints, points).with_interpolation(interpolation))
}
