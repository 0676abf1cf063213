//! The commands that the guide shows run, and end as it says.

mod shell;

use shell::{Folder, d2m, stderr};
use std::fs;
use std::path::{Path, PathBuf};

/// The pages of the guide.
fn pages() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide");
    let pages = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> = pages.filter(|path| path.extension().is_some_and(|e| e == "md")).collect();
    pages.sort();
    pages
}

/// The lines of a page's `sh` blocks that call the command.
fn commands(page: &str) -> Vec<String> {
    let blocks = page.split("```sh\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    blocks.flat_map(str::lines).filter(|line| line.starts_with("d2m ")).map(str::to_owned).collect()
}

/// The words of a line up to a comment, as a shell splits them where only double quotes are used.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quoted) = (Vec::new(), String::new(), false);
    for letter in line.chars() {
        match letter {
            '"' => quoted = !quoted,
            '#' if !quoted && word.is_empty() => break,
            ' ' if !quoted => words.push(std::mem::take(&mut word)),
            _ => word.push(letter),
        }
    }
    words.push(word);
    words.retain(|word| !word.is_empty());
    words
}

#[test]
fn every_command_of_the_guide_runs() {
    let folder = Folder::new("guide");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut count = 0;
    for page in pages() {
        for line in commands(&fs::read_to_string(&page).unwrap()) {
            let inputs = words(&line).into_iter().skip(1).map(|word| {
                let ending = Path::new(&word).extension().unwrap_or_default().to_owned();
                if word.starts_with("docs/") {
                    root.join(word).display().to_string()
                } else if ["html", "jsonl", "png"].iter().any(|end| ending == *end) {
                    folder.path(&word)
                } else {
                    word
                }
            });
            let inputs: Vec<String> = inputs.collect();
            let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
            let output = d2m(&inputs);
            assert_eq!(output.status.code(), Some(0), "{}: {line}\n{}", page.display(), stderr(&output));
            count += 1;
        }
    }
    assert!(count >= 10, "{count} commands");
}
