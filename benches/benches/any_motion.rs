//! What motions of every kind cost against constant twists: `cargo bench -p d2m-benches --bench any_motion [-- FLIGHTS [ROUNDS]]`.
//! Every answer is checked by distances at rest before it is timed; ratios are of medians of one run.
use d2m_benches::any_motion::{Bodies, measure};

fn main() {
    let numbers: Vec<usize> = std::env::args().filter_map(|text| text.parse().ok()).collect();
    let flights = numbers.first().copied().unwrap_or(64);
    let rounds = numbers.get(1).copied().unwrap_or(5) as u32;
    println!(
        "{:<60} {:>9} {:>9} {:>7} {:>10}  wanted",
        "least times of a query, µs", "median", "worst", "ratio", "worst/med."
    );
    let bodies = Bodies::new(1.0);
    let mut faults = 0;
    for rows in bodies.groups(flights) {
        match measure(&rows, rounds) {
            Ok(times) => {
                for (row, time) in rows.iter().zip(&times) {
                    let ratio = row.against.map(|(of, _)| time.median / times[of].median);
                    let wanted = row.against.filter(|(_, most)| most.is_finite());
                    let wanted = wanted.map_or(String::new(), |(_, most)| format!("ratio <= {most}"));
                    let most = row.most.map_or(String::new(), |most| format!(" median <= {most}"));
                    println!(
                        "{:<60} {:>9.1} {:>9.1} {:>7} {:>10.1}  {wanted}{most}",
                        row.name,
                        time.median,
                        time.worst,
                        ratio.map_or(String::new(), |ratio| format!("{ratio:.2}")),
                        time.worst / time.median,
                    );
                }
            }
            Err(fault) => {
                println!("WRONG: {fault}");
                faults += 1;
            }
        }
    }
    std::process::exit(i32::from(faults > 0));
}
