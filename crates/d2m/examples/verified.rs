//! Prints that an answer is proven again by code that shares nothing with the search, and that a wrong answer is not.
//!
//! `cargo run -p d2m --features verify --example verified`

use d2m::verify::{DEFAULT_STEPS, Verdict, Verifier};
use d2m::{ConstantTwist, MeshTree, Moving, QueryOptions, TimeOfContact, Window, time_of_contact};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mesh = d2m::shapes::mesh("gear?triangles=1000")?;
    let verifier = Verifier::try_new(&mesh, &mesh)?;
    let tree = MeshTree::new(mesh);
    let flying: ConstantTwist = "x=-3,0.1,0.2;v=4,0,0;w=0,1,2".parse()?;
    let bodies = [Moving::new(&tree, &flying), Moving::new(&tree, &ConstantTwist::REST)];
    let options = QueryOptions::default();
    let answer = time_of_contact(bodies[0], bodies[1], Window::UNIT, &options)?;
    let prove = |answer: &TimeOfContact| {
        verifier.time_of_contact(&bodies, Window::UNIT, &options, answer, DEFAULT_STEPS)
    };

    let verdict = prove(&answer);
    let Verdict::Verified { steps } = verdict else { return Err(format!("{verdict:?}").into()) };
    println!("free until {:?}: verified in {steps} steps", answer.contact().map(|contact| contact.time_lo));

    // Who says that nothing meets is wrong, and shown two triangles and a time.
    let lie = prove(&TimeOfContact::Separated);
    println!("\"separated\": {lie:?}");
    assert!(matches!(lie, Verdict::Refuted { .. }));
    Ok(())
}

#[test]
fn its_answers_are_right() {
    main().unwrap();
}
