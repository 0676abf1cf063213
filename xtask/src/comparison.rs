//! `cargo xtask comparison`: the table of the guide that sets this library beside others.
//!
//! Facts, each with its source, are those of `docs/guide/comparison.toml`; figures are those of the newest folder of `docs/results`,
//! which `cargo xtask bench` and `cargo xtask report` have made. `tidy` fails when the page says anything else.
use crate::{TaskResult, workspace_root};
use serde::Deserialize;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

const FACTS: &str = "docs/guide/comparison.toml";
const PAGE: &str = "docs/guide/migrating.md";
const RESULTS: &str = "docs/results";
/// What is between these lines of the page is written here.
const BEGIN: &str = "<!-- written by cargo xtask comparison -->";
const END: &str = "<!-- end of what cargo xtask comparison writes -->";
/// The rows of a table of the bench that repeat all others together.
const ALL_PAIRS: &str = "all";
/// Our method in the table of the bench, and our name among the peers.
const OWN_METHOD: &str = "accurate";
const OWN_PEERS: [&str; 2] = ["d2m accurate", "d2m features"];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Facts {
    library: Vec<Library>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Library {
    name: String,
    motion: String,
    answer: String,
    miss: String,
    rounding: String,
    source: String,
    /// A method of summary.csv.
    bench: Option<String>,
    /// A peer of peers.csv.
    peer: Option<String>,
}

/// Writes the table into its page.
pub(crate) fn run() -> TaskResult {
    let root = workspace_root();
    let page = fs::read_to_string(root.join(PAGE))?;
    fs::write(root.join(PAGE), with_table(&page, &table(&root)?)?)?;
    Ok(())
}

/// One finding when the page does not say what facts and figures say.
pub(crate) fn check(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let page = fs::read_to_string(root.join(PAGE))?;
    let differs = with_table(&page, &table(root)?)? != page;
    Ok(differs.then(|| format!("{PAGE}: its table is old: cargo xtask comparison")).into_iter().collect())
}

fn with_table(page: &str, table: &str) -> Result<String, Box<dyn std::error::Error>> {
    let parts = page.split_once(BEGIN).and_then(|(before, rest)| Some((before, rest.split_once(END)?.1)));
    let (before, after) = parts.ok_or_else(|| format!("{PAGE} has no lines {BEGIN} and {END}"))?;
    Ok(format!("{before}{BEGIN}\n\n{table}\n{END}{after}"))
}

fn table(root: &Path) -> Result<String, Box<dyn std::error::Error>> {
    let facts: Facts = toml::from_str(&fs::read_to_string(root.join(FACTS))?)?;
    let folder = newest_results(&root.join(RESULTS))?;
    let read = |file: &str| Ok::<_, std::io::Error>(Rows::new(&fs::read_to_string(folder.join(file))?));
    let (bench, peers) = (read("summary.csv")?, read("peers.csv")?);
    let mut lines = vec![
        "| | motion | answer of a time of contact | a miss is possible | rounding is counted | measured, same meshes and trials | source |"
            .to_owned(),
        "|---|---|---|---|---|---|---|".to_owned(),
    ];
    for library in &facts.library {
        let measured = match (&library.bench, &library.peer) {
            (Some(method), _) => Some(of_bench(&bench, method)?),
            (None, Some(peer)) => Some(of_peers(&peers, peer)?),
            (None, None) => None,
        };
        let measured = measured.map_or("–".to_owned(), |measured| measured.words());
        let Library { name, motion, answer, miss, rounding, source, .. } = library;
        lines.push(format!("| {name} | {motion} | {answer} | {miss} | {rounding} | {measured} | {source} |"));
    }
    Ok(lines.join("\n") + "\n")
}

/// The folder whose bench began last.
fn newest_results(results: &Path) -> Result<PathBuf, Box<dyn std::error::Error>> {
    let mut found: Vec<(String, PathBuf)> = Vec::new();
    for entry in fs::read_dir(results)? {
        let folder = entry?.path();
        if let Ok(machine) = fs::read_to_string(folder.join("machine.json")) {
            let machine: serde_json::Value = serde_json::from_str(&machine)?;
            found.push((machine["commit_date"].as_str().unwrap_or_default().to_owned(), folder));
        }
    }
    found.sort();
    found.pop().map(|(_, folder)| folder).ok_or_else(|| format!("{RESULTS} has no results").into())
}

/// The rows of a table without quotes, each by the names of its columns.
struct Rows(Vec<HashMap<String, String>>);

impl Rows {
    fn new(text: &str) -> Self {
        let mut lines = text.lines();
        let names: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
        let row = |line: &str| {
            names.iter().zip(line.split(',')).map(|(n, v)| ((*n).to_owned(), v.to_owned())).collect()
        };
        Self(lines.map(row).collect())
    }
}

/// What was measured of one library, over all pairs and speeds.
#[derive(Debug, Default, PartialEq)]
struct Measured {
    queries: u64,
    /// Not finished within the time that a query may take in the bench.
    unfinished: u64,
    /// Missed, late, or judged wrong.
    wrong: u64,
    /// Least and greatest ratio of its median time to ours.
    ratios: Option<[f64; 2]>,
    /// Least and greatest of our own medians, microseconds.
    own: Option<[f64; 2]>,
}

impl Measured {
    fn words(&self) -> String {
        let Self { queries, unfinished, wrong, ratios, own } = self;
        let unfinished = match unfinished {
            0 => String::new(),
            count => format!(", {count} not done within the cap"),
        };
        let time = match (own, ratios.map(|ends| ends.map(two_digits))) {
            (Some([least, most]), _) => format!("; {least:.0} to {most:.0} µs"),
            (None, Some([least, most])) if least == most => format!("; {least} times as long"),
            (None, Some([least, most])) => format!("; {least} to {most} times as long"),
            (None, None) => String::new(),
        };
        format!("{queries} queries, {wrong} missed or late{unfinished}{time}")
    }
}

fn extend(range: &mut Option<[f64; 2]>, value: f64) {
    let [least, most] = range.unwrap_or([value; 2]);
    *range = Some([least.min(value), most.max(value)]);
}

/// A ratio with two digits, thousands apart.
fn two_digits(ratio: f64) -> String {
    let power = 10f64.powi(ratio.log10().floor() as i32 - 1);
    let rounded = (ratio / power).round() * power;
    if rounded < 10.0 {
        return format!("{rounded:.1}");
    }
    let text = format!("{rounded:.0}");
    let grouped = text.as_bytes().rchunks(3).rev().map(|three| String::from_utf8_lossy(three).into_owned());
    grouped.collect::<Vec<_>>().join(" ")
}

fn number(row: &HashMap<String, String>, column: &str) -> Result<f64, Box<dyn std::error::Error>> {
    let text = row.get(column).ok_or_else(|| format!("a table of results has no column {column}"))?;
    text.parse().map_err(|_| format!("{text:?} in the column {column} is no number").into())
}

/// A method of the bench, by the rows of the same pairs at the same speeds.
fn of_bench(rows: &Rows, method: &str) -> Result<Measured, Box<dyn std::error::Error>> {
    let key = |row: &HashMap<String, String>| (row["pair"].clone(), row["speed"].clone());
    let of = |name: &str| {
        let is_one = |row: &&HashMap<String, String>| row["method"] == name && row["pair"] != ALL_PAIRS;
        rows.0.iter().filter(is_one).collect::<Vec<_>>()
    };
    let (own, theirs) = (of(OWN_METHOD), of(method));
    let mut measured = Measured::default();
    for row in theirs {
        measured.queries += number(row, "queries")? as u64;
        measured.unfinished += if method == OWN_METHOD { 0 } else { number(row, "undecided")? as u64 };
        measured.wrong += number(row, "wrong")? as u64;
        let time = number(row, "time_median")?;
        if method == OWN_METHOD {
            extend(&mut measured.own, time);
        } else if let Some(ours) = own.iter().find(|own| key(own) == key(row)) {
            extend(&mut measured.ratios, time / number(ours, "time_median")?);
        }
    }
    if measured.queries == 0 {
        Err(format!("summary.csv has no method {method}").into())
    } else {
        Ok(measured)
    }
}

/// A peer outside of Rust, by the rows of the same trials.
fn of_peers(rows: &Rows, peer: &str) -> Result<Measured, Box<dyn std::error::Error>> {
    let mut measured = Measured::default();
    for row in rows.0.iter().filter(|row| row["peer"] == peer) {
        measured.queries += number(row, "queries")? as u64;
        measured.wrong += number(row, "late")? as u64;
        let is_ours = |own: &&HashMap<String, String>| {
            OWN_PEERS.contains(&own["peer"].as_str()) && own["on"] == row["on"]
        };
        if let Some(ours) = rows.0.iter().find(is_ours) {
            let ratio = number(row, "time_median")? / number(ours, "time_median")?;
            extend(&mut measured.ratios, ratio);
        }
    }
    if measured.queries == 0 { Err(format!("peers.csv has no peer {peer}").into()) } else { Ok(measured) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_the_same_trials_are_compared() {
        let bench = "pair,speed,method,queries,undecided,wrong,time_median\n\
                     a,4,accurate,10,0,0,2.0e1\na,4,slow,3,1,0,1.0e6\nb,4,accurate,9,0,0,1.0e1\nb,4,slow,2,0,1,5.0e3\n\
                     all,4,accurate,19,0,0,1.5e1\nall,4,slow,5,1,1,1.0e6\n";
        let slow = of_bench(&Rows::new(bench), "slow").unwrap();
        let expected =
            Measured { queries: 5, unfinished: 1, wrong: 1, ratios: Some([500.0, 50_000.0]), own: None };
        assert_eq!(of_bench(&Rows::new(bench), OWN_METHOD).unwrap().queries, 19);
        assert_eq!(slow, expected);
        assert_eq!(
            slow.words(),
            "5 queries, 1 missed or late, 1 not done within the cap; 500 to 50 000 times as long"
        );
        assert!(of_bench(&Rows::new(bench), "nosuch").is_err());
        let peers = "peer,on,queries,late,time_median\nX,a,64,60,8.0e3\nd2m accurate,a,64,0,2.0e1\n";
        assert_eq!(of_peers(&Rows::new(peers), "X").unwrap().ratios, Some([400.0; 2]));
        assert!(of_peers(&Rows::new(peers), "Y").is_err());
    }

    #[test]
    fn only_what_is_marked_is_written() {
        let page = format!("before\n{BEGIN}\nold\n{END}\nafter\n");
        let new = with_table(&page, "| new |\n").unwrap();
        assert_eq!(new, format!("before\n{BEGIN}\n\n| new |\n\n{END}\nafter\n"));
        assert_eq!(with_table(&new, "| new |\n").unwrap(), new);
        assert!(with_table("no marks", "").is_err());
        assert_eq!(
            ["1.04", "37.4", "1249", "52340"].map(|x| two_digits(x.parse().unwrap())),
            ["1.0", "37", "1 200", "52 000"]
        );
    }
}
