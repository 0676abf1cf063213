//! `d2m demo`: the main job on built-in shapes.

use crate::arguments::{Arguments, Command};
use crate::commands::toc;
use crate::failure::Failure;
use crate::output::print;
use clap::Parser;

/// A sentence and the `d2m toc` arguments that answer it.
const SCENES: [(&str, &[&str]); 6] = [
    (
        "A spinning knot of 70 000 triangles flies into a tumbling gear.",
        &[
            "shape:torus-knot?triangles=70000",
            "shape:gear",
            "--motion-a",
            "x=-3,0.1,0;v=4,0,0;w=0,1,2",
            "--motion-b",
            "w=1,0,1",
        ],
    ),
    (
        "A bullet at 100 000 units per unit of time meets a plate one ten-thousandth thick.",
        &[
            "shape:needle?aspect=8&triangles=64",
            "shape:plate?thickness=1e-4&triangles=4800",
            "--motion-a",
            "x=0.2,0.1,50;v=0,0,-1e5;w=0,0,40",
            "--window",
            "0,0.001",
        ],
    ),
    (
        "A nut with little play climbs its screw by half a turn: nothing touches.",
        &[
            "shape:nut?triangles=1000&clearance=0.01",
            "shape:screw?triangles=2000",
            "--motion-a",
            "w=0,0,3.141592653589793;v=0,0,0.09611386626644256",
        ],
    ),
    (
        "The same nut turns without climbing: the threads jam.",
        &[
            "shape:nut?triangles=1000&clearance=0.01",
            "shape:screw?triangles=2000",
            "--motion-a",
            "w=0,0,3.141592653589793",
        ],
    ),
    (
        "A stone drifts in the cavity of a hollow sphere until it meets the wall from inside.",
        &[
            "shape:pebble?scale=0.5",
            "shape:hollow-sphere",
            "--motion-a",
            "v=0.2,0.6,0.1;w=0.3,0.1,0.2",
            "--motion-b",
            "w=0,0,1",
        ],
    ),
    (
        "A box that starts inside a ball: two solids are in contact from the start (with --surface it meets the shell).",
        &["shape:box?scale=0.3", "shape:icosphere?triangles=20480", "--motion-a", "v=2,0,0"],
    ),
];

/// Runs the command.
pub(crate) fn run() -> Result<(), Failure> {
    for (number, (sentence, arguments)) in SCENES.iter().enumerate() {
        let quoted: Vec<String> = arguments
            .iter()
            .map(|word| {
                let is_plain = word.chars().all(|c| c.is_ascii_alphanumeric() || ":-.,".contains(c));
                if is_plain { (*word).to_owned() } else { format!("'{word}'") }
            })
            .collect();
        let gap = if number == 0 { "" } else { "\n" };
        print(&format!("{gap}{}. {sentence}\n$ d2m toc {}\n", number + 1, quoted.join(" ")))?;
        let words = ["d2m", "toc"].iter().chain(arguments.iter());
        if let Command::Toc(arguments) = Arguments::parse_from(words).command {
            toc::run(&arguments)?;
        }
    }
    Ok(())
}
