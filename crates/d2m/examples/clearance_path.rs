//! Prints how near a tool comes to a part along each span of its path, and when it is closest.
//!
//! `cargo run -p d2m --example clearance_path`

use d2m::glam::DVec3;
use d2m::{ClearanceOptions, ConstantTwist, Keyframes, MeshTree, Moving, Pose, Span, Window, clearance};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let part = MeshTree::new(d2m::shapes::mesh("torus?triangles=2000")?); // a ring of radius 1 about z
    let tool = MeshTree::new(d2m::shapes::mesh("box?x=0.1&y=0.1&z=0.5")?);
    // Through the hole of the ring, then around it.
    let stops = [[0.0, 0.0, 2.0], [0.0, 0.0, -2.0], [2.0, 0.0, -2.0], [2.0, 0.0, 2.0]];
    let poses: Vec<(f64, Pose)> = (0..)
        .zip(stops)
        .map(|(k, stop)| (f64::from(k), Pose { translation: DVec3::from(stop), ..Pose::IDENTITY }))
        .collect();
    let path = Keyframes::try_new(&poses, Span::Linear)?;

    let (a, b) = (Moving::new(&tool, &path), Moving::new(&part, &ConstantTwist::REST));
    let options = ClearanceOptions::default().with_accuracy(1e-4);
    let mut least = f64::INFINITY;
    for span in path.spans() {
        let nearest = clearance(a, b, Window::try_new(span.start, span.end)?, &options)?;
        println!(
            "from {} to {}: at least {:.6}, at most {:.6}, at time {:.4}",
            span.start, span.end, nearest.lower, nearest.upper, nearest.time
        );
        least = least.min(nearest.lower);
    }
    // The hole has the radius 0.4, a little more between the vertices of the mesh; the tool reaches 0.1·√2 from its middle.
    assert!((0.0..5e-3).contains(&(least - (0.4 - 0.1 * 2f64.sqrt()))));
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
