//! Prints how many of a thousand throws hit, asked on all threads at once, and that one thread gives the same answers.
//!
//! `cargo run -p d2m --example many_pairs`

use d2m::glam::DVec3;
use d2m::{ConstantTwist, MeshTree, Moving, QueryOptions, Window, time_of_contact, time_of_contact_batch};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let tree = |shape: &str| d2m::shapes::mesh(shape).map(MeshTree::new);
    let (knot, stone) = (tree("torus-knot?triangles=2000")?, tree("pebble?triangles=500&scale=0.2")?);
    let throws: Vec<ConstantTwist> = (0..1000)
        .map(|k| {
            let (row, column) = (f64::from(k / 40), f64::from(k % 40));
            ConstantTwist::REST
                .with_position(DVec3::new(0.1 * row - 1.2, 0.06 * column - 1.2, 3.0))
                .with_linear_velocity(DVec3::Z * -6.0)
                .with_angular_velocity(DVec3::new(row, column, 1.0))
        })
        .collect();
    let rest = ConstantTwist::REST;
    let pairs: Vec<_> =
        throws.iter().map(|throw| (Moving::new(&stone, throw), Moving::new(&knot, &rest))).collect();
    let answers = time_of_contact_batch(&pairs, Window::UNIT, &QueryOptions::default());
    let hits = answers.iter().filter(|answer| answer.is_ok_and(|found| found.contact().is_some())).count();
    println!("{hits} of {} throws hit the knot", pairs.len());
    assert!(hits > 100 && hits < 900);

    // The same bits, however many threads there are.
    for (&(a, b), answer) in pairs.iter().zip(&answers).step_by(100) {
        assert_eq!(&time_of_contact(a, b, Window::UNIT, &QueryOptions::default()), answer);
    }
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
