use super::{Movement, Trial};
use glam::{DQuat, DVec3};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Reads trials: no header, 26 finite numbers a line, qA(w,x,y,z) xA vA wA qB xB vB wB.
///
/// # Errors
/// Names file, line and column of what is not a trial.
pub(crate) fn read(path: &Path) -> Result<Vec<Trial>, Box<dyn std::error::Error>> {
    let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut trials = Vec::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let place = |column: usize| format!("{}:{}: column {column}", path.display(), index + 1);
        let mut numbers = [0.0; 26];
        let mut count = 0;
        for (column, field) in line.split(',').enumerate() {
            let value: f64 =
                field.trim().parse().map_err(|_| format!("{}: no number: {field}", place(column + 1)))?;
            if !value.is_finite() {
                return Err(format!("{}: not finite: {field}", place(column + 1)).into());
            }
            *numbers
                .get_mut(column)
                .ok_or_else(|| format!("{}: more than 26 numbers", place(column + 1)))? = value;
            count = column + 1;
        }
        if count != 26 {
            return Err(format!("{}: {count} numbers instead of 26", place(count)).into());
        }
        trials.push(Trial { a: movement(&numbers[..13]), b: movement(&numbers[13..]) });
    }
    Ok(trials)
}

fn movement(n: &[f64]) -> Movement {
    Movement {
        rotation: DQuat::from_xyzw(n[1], n[2], n[3], n[0]),
        position: DVec3::new(n[4], n[5], n[6]),
        velocity: DVec3::new(n[7], n[8], n[9]),
        angular_velocity: DVec3::new(n[10], n[11], n[12]),
    }
}

/// Writes trials so that [`read`] gives the same bits back.
pub(crate) fn write(path: &Path, trials: &[Trial]) -> std::io::Result<()> {
    let mut text = String::new();
    for trial in trials {
        let numbers: Vec<f64> = [trial.a, trial.b]
            .iter()
            .flat_map(|m| {
                let q = m.rotation;
                let vectors = [m.position, m.velocity, m.angular_velocity];
                [q.w, q.x, q.y, q.z].into_iter().chain(vectors.into_iter().flat_map(|v| v.to_array()))
            })
            .collect();
        for (column, number) in numbers.iter().enumerate() {
            let separator = if column == 0 { "" } else { "," };
            let _ = write!(text, "{separator}{number:?}");
        }
        text.push('\n');
    }
    fs::write(path, text)
}
