//! Sizes that people mix up: the scale and unit of the meshes, and what is echoed of them.

use crate::arguments::{SizeArgument, SizeArguments};
use crate::failure::Failure;
use crate::load::{Loaded, load_with};
use crate::output::{digits, printable};
use crate::travel::Travel;
use d2m_io::{ReadOptions, Unit};
use glam::DVec3;

/// Loads two meshes in the sizes that the options state.
pub(crate) fn load_both(a: &str, b: &str, sizes: &SizeArguments) -> Result<[Loaded; 2], Failure> {
    let options_a = read_options("-a", sizes.scale_a.as_deref(), sizes.unit_a.as_deref())?;
    let options_b = read_options("-b", sizes.scale_b.as_deref(), sizes.unit_b.as_deref())?;
    Ok([load_with(a, &options_a)?, load_with(b, &options_b)?])
}

/// Loads one mesh in the size that `--scale` and `--unit` state.
pub(crate) fn load_one(mesh: &str, size: &SizeArgument) -> Result<Loaded, Failure> {
    load_with(mesh, &read_options("", size.scale.as_deref(), size.unit.as_deref())?)
}

/// The options are `--scale` and `--unit` with the letter of the body behind, where there are two.
fn read_options(body: &str, scale: Option<&str>, unit: Option<&str>) -> Result<ReadOptions, Failure> {
    let mut options = ReadOptions::new();
    if let Some(text) = unit {
        let unit: Unit = text.parse().map_err(|error| Failure::at(format!("--unit{body}"), error))?;
        options = options.with_unit(unit);
    }
    if let Some(text) = scale {
        let scale = parse_scale(text).map_err(|reason| Failure::at(format!("--scale{body}"), reason))?;
        options = options.with_scale(scale);
    }
    Ok(options)
}

/// One number, or three with commas between them.
fn parse_scale(text: &str) -> Result<DVec3, String> {
    let number = |word: &str| word.trim().parse::<f64>().map_err(|_| format!("{word:?} is not a number"));
    let numbers: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
    let scale = match numbers[..] {
        [all] => DVec3::splat(all),
        [x, y, z] => DVec3::new(x, y, z),
        _ => return Err(format!("{text:?} has {} numbers: one is needed, or three", numbers.len())),
    };
    if scale.is_finite() && scale.abs().min_element() > 0.0 {
        Ok(scale)
    } else {
        Err(format!("{text} has to be finite and not zero"))
    }
}

/// The last line of an answer: how large each body is, and how far it goes and turns in the window.
pub(crate) fn sizes_line(sizes: [f64; 2], travels: Option<[Travel; 2]>) -> String {
    let one = |index: usize| {
        let name = ["A", "B"][index];
        let size = digits(sizes[index]);
        match travels.map(|travels| travels[index]) {
            None => format!("{name} is {size} across"),
            Some(Travel { way, turn }) => {
                format!(
                    "{name} is {size} across, moves {} and turns {}°",
                    digits(way),
                    digits(turn.to_degrees())
                )
            }
        }
    };
    format!("  {:<12}{} · {}\n", "sizes", one(0), one(1))
}

/// The same of many bodies, each with its name, its size, and how far it goes and turns: those that stand out.
pub(crate) fn scene_sizes_line(bodies: &[(&str, f64, Travel)]) -> String {
    let most = |of: fn(&(&str, f64, Travel)) -> f64| bodies.iter().max_by(|x, y| of(x).total_cmp(&of(y)));
    let size = |body: &(&str, f64, Travel)| body.1;
    let small = bodies.iter().min_by(|x, y| size(x).total_cmp(&size(y)));
    let (Some(small), Some(large), Some(far), Some(turned)) =
        (small, most(size), most(|body| body.2.way), most(|body| body.2.turn))
    else {
        return String::new();
    };
    let [smallest, largest, farthest, most_turned] =
        [small, large, far, turned].map(|body| printable(body.0));
    format!(
        "  {:<12}from {} ({}) to {} ({}) across · moves up to {} ({}) · turns up to {}° ({})\n",
        "sizes",
        digits(small.1),
        smallest,
        digits(large.1),
        largest,
        digits(far.2.way),
        farthest,
        digits(turned.2.turn.to_degrees()),
        most_turned,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m::bvh::Window;

    #[test]
    fn scales_are_one_number_or_three() {
        assert_eq!(parse_scale("0.001"), Ok(DVec3::splat(0.001)));
        assert_eq!(parse_scale("1, -2,3"), Ok(DVec3::new(1.0, -2.0, 3.0)));
        for (text, expected) in [
            ("0", "not zero"),
            ("1,0,1", "not zero"),
            ("inf", "finite"),
            ("1,2", "2 numbers"),
            ("x", "\"x\" is not"),
        ] {
            assert!(parse_scale(text).unwrap_err().contains(expected), "{text}");
        }
    }

    #[test]
    fn a_line_says_size_way_and_turn() {
        let motion: d2m::ConstantTwist = "v=3,4,0;w=0,0,90deg".parse().unwrap();
        let travel = Travel::of(&motion.into(), Window::UNIT);
        let rest = Travel::of(&d2m::ConstantTwist::REST.into(), Window::UNIT);
        let line = sizes_line([0.25, 1e-9 / 3.0], Some([travel, rest]));
        assert_eq!(
            line,
            "  sizes       A is 0.25 across, moves 5 and turns 90° · B is 3.333e-10 across, moves 0 and turns 0°\n"
        );
    }
}
