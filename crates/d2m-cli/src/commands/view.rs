//! `d2m view`: a page of HTML that shows what moves.

use crate::arguments::ViewArguments;
use crate::engine::{Pair, check_size, options_of};
use crate::failure::Failure;
use crate::load::load;
use crate::motion::{parse_motion, parse_window, require_window};
use crate::output::Output;
use crate::report;
use crate::view::{Mark, Picture, flights_of, picture_of_run, picture_of_scene};
use d2m::bvh::{StartState, TimeOfContact};
use std::path::Path;

/// Runs the command.
pub(crate) fn run(arguments: &ViewArguments) -> Result<(), Failure> {
    let inputs = [Some(&arguments.a), arguments.b.as_ref()].into_iter().flatten();
    let out = Output::new(&arguments.out)?.spare(inputs.map(Path::new))?;
    let extension = Path::new(&arguments.a).extension().unwrap_or_default().to_ascii_lowercase();
    let (is_run, is_scene) = (extension == "jsonl", extension == "json");
    let picture = match &arguments.b {
        Some(b) if is_run || is_scene => {
            return Err(Failure::at(b, "a scene or a simulation is viewed alone"));
        }
        Some(b) => pair(arguments, b)?,
        None if is_run => picture_of_run(Path::new(&arguments.a))?,
        None if is_scene => picture_of_scene(Path::new(&arguments.a), options_of(&arguments.query)?)?,
        None => return Err(Failure::at("B", "the second mesh is missing")),
    };
    out.write(&picture.to_html())
}

/// Two moving meshes and their first contact.
fn pair(arguments: &ViewArguments, b: &str) -> Result<Picture, Failure> {
    let window = parse_window(&arguments.window)?;
    let motions =
        [parse_motion("--motion-a", &arguments.motion_a)?, parse_motion("--motion-b", &arguments.motion_b)?];
    require_window("--motion-a", &motions[0], window)?;
    require_window("--motion-b", &motions[1], window)?;
    let pair = Pair::new(load(&arguments.a)?, load(b)?, &arguments.query)?.on_all_threads();
    check_size("--motion-a", &motions[0], &pair.a)?;
    check_size("--motion-b", &motions[1], &pair.b)?;
    let answer = pair.answer(&motions[0], &motions[1], window)?;
    let text = report::text(&pair, window, &answer);
    let mut lines = text.lines().map(|line| line.trim().to_owned());
    let headline = lines.next().unwrap_or_default();
    let facts = lines.take_while(|line| !line.starts_with("point on A")).collect();
    let mut picture = Picture::new(headline, facts, [window.start(), window.end()], false);
    for (label, body, motion) in [("A", &pair.a, &motions[0]), ("B", &pair.b, &motions[1])] {
        let mesh = picture.add_mesh(body.mesh());
        picture.add_body(&format!("{label}: {}", body.name), mesh, &flights_of(motion, window));
    }
    if let TimeOfContact::Contact(contact) = &answer.verdict
        && contact.start != StartState::Contained
    {
        let (point, normal) = ((contact.point_a + contact.point_b) * 0.5, contact.normal);
        picture.add_mark(&Mark { from: contact.time_lo, until: window.end(), point, normal });
    }
    Ok(picture)
}
