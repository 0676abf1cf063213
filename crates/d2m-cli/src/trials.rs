//! Trials: 26 numbers a line, the motions of A and of B, or a JSON object a line with motions of any form.

use crate::failure::{Failure, json_fault};
use crate::load::{named, read};
use crate::motion::require_window;
use crate::orientation::{WRITTEN, has_odd_length};
use d2m::bvh::{MAX_COORDINATE, Window};
use d2m::motion::{AnyMotion, ConstantTwist};
use glam::{DQuat, DVec3};
use serde::Deserialize;
use std::path::Path;

/// One line of a trials file.
#[derive(Debug, Clone)]
pub(crate) struct Trial {
    /// Line of the file, from 1.
    pub(crate) line: usize,
    pub(crate) motion_a: AnyMotion,
    pub(crate) motion_b: AnyMotion,
    pub(crate) window: Window,
    /// Has it a quaternion that is not of length one?
    pub(crate) has_odd_orientation: bool,
}

/// A line of JSON.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TrialForm {
    #[serde(default = "at_rest")]
    a: AnyMotion,
    #[serde(default = "at_rest")]
    b: AnyMotion,
    #[serde(default = "unit_window")]
    window: [f64; 2],
}

const fn at_rest() -> AnyMotion {
    AnyMotion::ConstantTwist(ConstantTwist::REST)
}

const fn unit_window() -> [f64; 2] {
    [0.0, 1.0]
}

/// The names of the fields, for messages.
const FIELDS: [&str; 13] = ["qw", "qx", "qy", "qz", "x1", "x2", "x3", "v1", "v2", "v3", "w1", "w2", "w3"];

/// Reads a file; blank lines are skipped.
pub(crate) fn load(path: &Path) -> Result<Vec<Trial>, Failure> {
    let bytes = read(path)?;
    let text = String::from_utf8_lossy(&bytes);
    parse(&named(path), text.trim_start_matches('\u{feff}'))
}

fn parse(place: &str, text: &str) -> Result<Vec<Trial>, Failure> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let mut lines = lines.peekable();
    lines.next_if(|(_, line)| is_header(line));
    let trials: Vec<Trial> = lines
        .map(|(index, line)| {
            let number = index + 1;
            parse_line(line, number).map_err(|reason| Failure::at(format!("{place}, line {number}"), reason))
        })
        .collect::<Result<_, _>>()?;
    if trials.is_empty() { Err(Failure::at(place, "there are no trials")) } else { Ok(trials) }
}

/// Names of columns: several fields of printed characters, and none of them a number.
fn is_header(line: &str) -> bool {
    let mut fields = line.split(',').map(str::trim);
    line.contains(',')
        && !line.trim_start().starts_with('{')
        && fields.all(|field| field.parse::<f64>().is_err())
}

/// `{"a": motion, "b": motion, "window": [t0, t1]}`, each of which may be left out: at rest, from 0 to 1.
fn parse_json(text: &str, line: usize) -> Result<Trial, String> {
    let form: TrialForm = serde_json::from_str(text).map_err(|error| json_fault(&error, text))?;
    let [start, end] = form.window;
    let window = Window::try_new(start, end).map_err(|error| format!("window: {error}"))?;
    let has_odd_orientation = serde_json::from_str(text).is_ok_and(|value| has_odd_length(&value));
    let trial = Trial { line, motion_a: form.a, motion_b: form.b, window, has_odd_orientation };
    for (place, motion) in [("a", &trial.motion_a), ("b", &trial.motion_b)] {
        require_window(place, motion, window).map_err(|failure| failure.to_string())?;
    }
    Ok(trial)
}

fn parse_line(text: &str, line: usize) -> Result<Trial, String> {
    if text.trim_start().starts_with('{') {
        return parse_json(text, line);
    }
    let count = text.split(',').count();
    if count != 26 {
        return Err(format!("expected 26 numbers separated by commas, found {count}"));
    }
    let mut numbers = [0.0; 26];
    for (index, (number, word)) in numbers.iter_mut().zip(text.split(',')).enumerate() {
        let place = || format!("field {} ({} of {})", index + 1, FIELDS[index % 13], ["A", "B"][index / 13]);
        *number =
            word.trim().parse().map_err(|_| format!("{}: {:?} is not a number", place(), word.trim()))?;
        if !f64::is_finite(*number) {
            return Err(format!("{}: {} is not finite", place(), word.trim()));
        }
        // Before hours of other trials, not after them.
        if number.abs() > MAX_COORDINATE {
            let word = word.trim();
            return Err(format!("{}: {word} is larger than the limit of {MAX_COORDINATE:e}", place()));
        }
    }
    let motion = |n: &[f64], body: &str| {
        let vector = |at: usize| DVec3::new(n[at], n[at + 1], n[at + 2]);
        let orientation = DQuat::from_xyzw(n[1], n[2], n[3], n[0]);
        ConstantTwist::try_new(vector(4), orientation, vector(7), vector(10))
            .map_err(|error| format!("motion of {body}: {error}"))
    };
    let (motion_a, motion_b) = (motion(&numbers[..13], "A")?.into(), motion(&numbers[13..], "B")?.into());
    let is_odd = |q: &[f64]| (q.iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0).abs() > WRITTEN;
    let has_odd_orientation = is_odd(&numbers[..4]) || is_odd(&numbers[13..17]);
    Ok(Trial { line, motion_a, motion_b, window: Window::UNIT, has_odd_orientation })
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m::motion::RigidMotion;

    const LINE: &str = "1,0,0,0,1,2,3,4,5,6,7,8,9,0,1,0,0,-1,-2,-3,-4,-5,-6,-7,-8,-9";

    fn fault(text: &str) -> String {
        parse("t", text).unwrap_err().to_string()
    }

    #[test]
    fn order_of_the_fields() {
        let trials = parse("t", &format!("{LINE}\r\n\n {LINE}\n")).unwrap();
        assert_eq!((trials.len(), trials[0].line, trials[1].line), (2, 1, 3));
        let [a, b] = [&trials[0].motion_a, &trials[1].motion_b].map(|m| m.constant_twist().unwrap());
        assert_eq!(a.position(), DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(a.linear_velocity(), DVec3::new(4.0, 5.0, 6.0));
        assert_eq!(b.angular_velocity(), DVec3::new(-7.0, -8.0, -9.0));
        assert_eq!(b.orientation().x, 1.0);
    }

    #[test]
    fn lines_of_json_hold_any_motion() {
        let arm = r#"{"chain": [{"joint": "revolute", "axis": [0, 0, 1], "value": {"times": [0, 2], "pieces": [[0, 1]]}}]}"#;
        let line = format!("{LINE}\n{{\"a\": {arm}, \"window\": [0.5, 1.5]}}\n");
        let trials = parse("t", &line).unwrap();
        assert_eq!(trials[0].window, Window::UNIT);
        assert_eq!((trials[1].window.start(), trials[1].window.end()), (0.5, 1.5));
        assert!(matches!(&trials[1].motion_a, AnyMotion::Chain(chain) if chain.joints().len() == 1));
        assert_eq!(trials[1].motion_b, at_rest());
        let outside = fault(&format!("{{\"b\": {arm}, \"window\": [1, 3]}}"));
        assert!(
            outside.starts_with("t, line 1: b: the motion covers the times from 0.0 to 2.0"),
            "{outside}"
        );
        assert!(fault("{\"c\": {}}").contains("unknown field `c`"));
        assert!(fault("{\"window\": [1, 0]}").contains("window"));
    }

    #[test]
    fn a_header_line_is_skipped() {
        let names: Vec<String> =
            (0..26).map(|k| format!("{}{}", FIELDS[k % 13], ["A", "B"][k / 13])).collect();
        let trials = parse("t", &format!("\n{}\r\n{LINE}\n", names.join(","))).unwrap();
        assert_eq!((trials.len(), trials[0].line), (1, 3));
        assert_eq!(fault("a,b,c\n"), "t: there are no trials");
        // Only the first line is one, and not where a number stands in it.
        assert!(fault(&format!("{LINE}\na,b\n")).starts_with("t, line 2: "));
        assert!(fault(&names.join(",").replace("qwA", "1")).starts_with("t, line 1: "));
    }

    #[test]
    fn faults_name_line_and_field() {
        assert_eq!(fault("\n\n"), "t: there are no trials");
        let short = fault(&format!("{LINE}\n1,2,3\n"));
        assert_eq!(short, "t, line 2: expected 26 numbers separated by commas, found 3");
        let word = fault(&format!("\n{}", LINE.replace("-4", "four")));
        assert_eq!(word, "t, line 2: field 21 (v1 of B): \"four\" is not a number");
        let infinite = fault(&LINE.replace("-9", "1e999"));
        assert_eq!(infinite, "t, line 1: field 26 (w3 of B): 1e999 is not finite");
        let far = fault(&LINE.replace("-9", "1e300"));
        assert_eq!(far, "t, line 1: field 26 (w3 of B): 1e300 is larger than the limit of 1e60");
        let zero = fault(&LINE.replacen('1', "0", 1));
        assert!(zero.starts_with("t, line 1: motion of A: orientation (0.0, 0.0, 0.0, 0.0)"), "{zero}");
    }
}
