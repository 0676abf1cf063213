//! Random small scenes: default engine against reference method against slow oracle.
//!
//! `cargo run --release -p d2m-bvh --example cross_check -- COUNT [SEED]`

fn main() {
    let mut arguments = std::env::args().skip(1).map(|a| a.parse::<u64>().expect("a number"));
    let (count, seed) = (arguments.next().unwrap_or(1000), arguments.next().unwrap_or(1));
    let started = std::time::Instant::now();
    let report = d2m_bvh::paper::cross_check(count as usize, seed);
    for complaint in &report.complaints {
        println!("{complaint}");
    }
    println!(
        "{} scenes, {} contacts, undecided {:?}, open brackets {:?}, loose {:?}, {} complaints, {:.1} s",
        report.scenes,
        report.contacts,
        report.undecided,
        report.open_brackets,
        report.loose_brackets,
        report.complaints.len(),
        started.elapsed().as_secs_f64()
    );
    std::process::exit(i32::from(!report.complaints.is_empty()));
}
