//! Prints when a vertex of a cloth that is stretched passes a triangle, each of whose vertices moves by itself.
//!
//! `cargo run -p d2m --example straight_paths`

use d2m::feature::{ContactOptions, FirstContact, StraightPaths};
use d2m::glam::DVec3;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    // One step of a simulation of cloth: where four vertices are before and after it. They move on straight lines.
    let vertex = [DVec3::new(0.2, 0.2, 1.0), DVec3::new(0.2, 0.2, -0.5)];
    let triangle = [[DVec3::ZERO, DVec3::Z * 0.1], [DVec3::X, DVec3::X * 1.2], [DVec3::Y, DVec3::Y * 0.9]];
    let at = |k: usize| [vertex[k], triangle[0][k], triangle[1][k], triangle[2][k]];
    let paths = StraightPaths::new(at(0), at(1));

    let FirstContact::Contact(touch) = paths.point_triangle(&ContactOptions::new()) else {
        return Err("the vertex passes the triangle".into());
    };
    println!("no contact before {:.12}, contact by {:.12} of the step", touch.lo, touch.hi);
    // Line searches keep a distance: the first time at which less than 0.01 is left.
    let keep = ContactOptions::new().with_min_separation(0.01);
    let FirstContact::Contact(near) = paths.point_triangle(&keep) else {
        return Err("it comes near before".into());
    };
    println!("further apart than 0.01 until {:.12}", near.lo);
    assert!(0.5 < near.lo && near.lo < touch.lo && touch.hi < 0.7);

    // The height of the vertex over the plane of the triangle changes its sign between the two ends of the bracket.
    let height = |t: f64| {
        let [p, a, b, c] = [0, 1, 2, 3].map(|k| at(0)[k].lerp(at(1)[k], t));
        (b - a).cross(c - a).dot(p - a)
    };
    assert!(height(touch.lo - 1e-9) > 0.0 && height(touch.hi + 1e-9) < 0.0);
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
