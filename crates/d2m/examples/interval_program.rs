//! An interval program: when does a body that is thrown in gusts come down? `cargo run -p d2m --example interval_program`
use d2m::interval::Interval;
use d2m::root::{FirstZero, SearchLimits, first_zero_of};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Its height, and how fast that changes.
    let height = |t: Interval| t * 12.0 - t.sqr() * 4.905 + (t * 6.0).sin() * 0.25 + 1.0;
    let rate = |t: Interval| -t * 9.81 + 12.0 + (t * 6.0).cos() * 1.5;
    let found = first_zero_of(height, rate, Interval::new(0.0, 5.0), SearchLimits::new(1e-12));
    let FirstZero::Found { bracket, evidence } = found else { return Err("it comes down".into()) };
    println!("it lands at {bracket}: {evidence:?}");
    // Rigorous on both sides, whatever the machine rounds.
    assert!(height(Interval::point(bracket.inf())).sup() > 0.0);
    assert!(height(Interval::point(bracket.sup())).inf() < 0.0);
    // No gust lifts it above 9: proven over all times at once, piece by piece.
    let highest = (0..500).map(|k| height(Interval::new(f64::from(k), f64::from(k + 1)) / 100.0).sup());
    assert!(highest.fold(0.0, f64::max) < 9.0);
    Ok(())
}

#[test]
fn it_lands_once() {
    main().unwrap();
}
