//! The table of hard scenes of docs/experiments.md: `cargo bench -p d2m-benches --bench hard_scenes [-- WORDS [ROUNDS]]`.
//! Every answer is judged by the construction of its scene before it is timed.
use d2m::bvh::{Answered, QueryOptions, Solid};
use d2m_benches::hard_scenes::{HardScene, table};
use d2m_benches::processor_time;
use std::sync::LazyLock;
use std::time::Instant;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let wanted = arguments.first().cloned().unwrap_or_default();
    let rounds: usize = arguments.get(1).and_then(|a| a.parse().ok()).unwrap_or(5);
    println!(
        "{:<64} {:>10} windows  tests     triangles sweeps/pairs   fault",
        "mean processor time of a query", "ms"
    );
    let mut faults = 0;
    for scene in table(1.0).into_iter().filter(|s| s.name.contains(&wanted)) {
        faults += usize::from(row(&scene, rounds));
    }
    std::process::exit(i32::from(faults > 0));
}

/// Prints a line; says whether the answer was wrong.
fn row(scene: &HardScene, rounds: usize) -> bool {
    let Answered { answer, work: counts } =
        scene.ask_counted(&QueryOptions::default().with_solid(Solid::Surface));
    let fault = scene.fault(&answer);
    // Long enough for the clock's ticks of a few milliseconds.
    let (clock, mut asked) = (milliseconds(), 0);
    while asked < rounds || milliseconds() - clock < 60.0 && asked < 1000 {
        let _ = std::hint::black_box(scene.ask());
        asked += 1;
    }
    let mean = (milliseconds() - clock) / asked as f64;
    println!(
        "{:<64} {mean:>10.3} {:<8} {:<9} {:<9} {:<14} {}",
        scene.name,
        counts.windows,
        counts.node_tests,
        counts.triangle_looks,
        format!("{}/{}", counts.sweeps, counts.swept_pairs),
        fault.as_deref().unwrap_or("")
    );
    fault.is_some()
}

/// Milliseconds that this thread has run; the clock's time where the system does not say.
fn milliseconds() -> f64 {
    static CLOCK: LazyLock<Instant> = LazyLock::new(Instant::now);
    processor_time().unwrap_or_else(|| CLOCK.elapsed()).as_secs_f64() * 1e3
}
