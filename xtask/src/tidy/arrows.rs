//! Arrows between the modules of a crate: they point one way, in the order that ARCHITECTURE.md gives, and no files form a
//! circle.
//!
//! An arrow is a path (`crate::…`, `super::…`, or the name of a child module in a `use`) outside tests and comments. A
//! name that a `mod.rs` or `lib.rs` passes on counts as an arrow to the file that it comes from, and one that a `mod.rs` defines
//! as an arrow to the folder. Between a folder's `mod.rs` and the files in it there are no arrows.
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// In ARCHITECTURE.md, before the list of a crate's modules: one line, from those that need nothing to those that use all.
const HEADING: &str = "Order of the modules of ";

/// Modules of an order that need each other, joined by this, have one place: a trait and the types that it names. Each such group
/// is an exception that ARCHITECTURE.md gives a reason for.
const TOGETHER: &str = " + ";

/// Before the circles of files of a crate that stay for a reason, each as one word of modules joined by [`TOGETHER`].
const CIRCLES: &str = "Circles of files that stay in ";

/// What points in the wrong direction. Every crate of more than one module has an order.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let text =
        fs::read_to_string(root.join("ARCHITECTURE.md")).map_err(|e| format!("ARCHITECTURE.md: {e}"))?;
    let (orders, allowed) = (lists(&text, HEADING), lists(&text, CIRCLES));
    let mut findings = Vec::new();
    let mut folders: Vec<_> =
        fs::read_dir(root.join("crates"))?.map(|entry| entry.map(|e| e.path())).collect::<Result<_, _>>()?;
    folders.push(root.join("xtask"));
    folders.sort();
    for folder in folders.iter().filter(|folder| folder.join("src").exists()) {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let modules = Modules::read(&folder.join("src"))?;
        match orders.iter().find(|(crate_name, _)| *crate_name == name) {
            Some((_, order)) => {
                let allowed = allowed.iter().find(|(crate_name, _)| *crate_name == name);
                findings.extend(modules.judge(&name, order, allowed.map_or(&[], |(_, list)| list)));
            }
            None if modules.0.len() > 2 => {
                let order: Vec<String> =
                    modules.proposed_order().iter().map(|name| format!("`{name}`")).collect();
                findings.push(format!(
                    "ARCHITECTURE.md: {name} has no order; one to begin with: {HEADING}`{name}`: {}.",
                    order.join(", ")
                ));
            }
            None => {}
        }
    }
    Ok(findings)
}

/// The crates whose modules are listed after such words, with the list.
fn lists(text: &str, heading: &str) -> Vec<(String, Vec<String>)> {
    let in_code =
        |line: &str| -> Vec<String> { line.split('`').skip(1).step_by(2).map(String::from).collect() };
    text.lines()
        .filter(|line| line.starts_with(heading))
        .filter_map(|line| {
            let mut words = in_code(line).into_iter();
            Some((words.next()?, words.collect()))
        })
        .collect()
}

/// The modules of a crate by their paths (the root's is empty), with the code outside tests and comments.
struct Modules(BTreeMap<Vec<String>, String>);

impl Modules {
    fn read(folder: &Path) -> Result<Self, Box<dyn std::error::Error>> {
        let mut modules = BTreeMap::new();
        for path in super::sources::files(folder)? {
            let relative = path.strip_prefix(folder).unwrap_or(&path).with_extension("");
            let mut segments: Vec<String> =
                relative.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            match segments.last().map(String::as_str) {
                Some("mod" | "lib" | "main") => drop(segments.pop()),
                Some("tests") => continue,
                _ => {}
            }
            modules.insert(segments, code(&fs::read_to_string(&path)?));
        }
        Ok(Self(modules))
    }

    fn judge(&self, name: &str, order: &[String], allowed: &[String]) -> Vec<String> {
        let arrows = self.arrows();
        let mut findings = Vec::new();
        for module in self.0.keys().filter(|module| place(order, module).is_none() && !self.passes_on(module))
        {
            findings
                .push(format!("{name}: {} is missing in the order of ARCHITECTURE.md", module.join("::")));
        }
        let is_module = |listed: &str| self.0.keys().any(|module| module.join("::") == listed);
        for listed in order.iter().flat_map(|group| group.split(TOGETHER)).filter(|listed| !is_module(listed))
        {
            findings.push(format!("{name}: {listed} in the order of ARCHITECTURE.md is no module"));
        }
        for (from, to) in arrows.iter().flat_map(|(from, all)| all.iter().map(move |to| (from, to))) {
            if place(order, from).zip(place(order, to)).is_some_and(|(own, other)| other > own) {
                findings.push(format!(
                    "{name}: {} uses {}, which stands after it in ARCHITECTURE.md: arrows point one way",
                    from.join("::"),
                    to.join("::")
                ));
            }
        }
        let stays = |circle: &BTreeSet<Vec<String>>| {
            let within =
                |names: &str| circle.iter().all(|m| names.split(TOGETHER).any(|n| n == m.join("::")));
            allowed.iter().any(|names| within(names))
        };
        for circle in circles(&arrows).into_iter().filter(|circle| !stays(circle)) {
            let circle: Vec<String> = circle.iter().map(|module| module.join("::")).collect();
            findings.push(format!("{name}: files that use each other in a circle: {}", circle.join(", ")));
        }
        findings
    }

    /// The modules right below the root, those first that use the fewest others: without circles an order that holds.
    fn proposed_order(&self) -> Vec<String> {
        let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (from, to) in self.arrows() {
            let Some(first) = from.first() else { continue };
            let used = uses.entry(first.clone()).or_default();
            used.extend(to.iter().filter_map(|to| to.first().cloned()).filter(|to| to != first));
        }
        let mut order = Vec::new();
        while !uses.is_empty() {
            let least = uses.iter().min_by_key(|(_, used)| used.len()).map(|(name, _)| name.clone());
            let Some(name) = least else { break };
            uses.remove(&name);
            for used in uses.values_mut() {
                used.remove(&name);
            }
            order.push(name);
        }
        order
    }

    /// A module with children: it may pass names on, and stands above them.
    fn passes_on(&self, module: &[String]) -> bool {
        self.0.keys().any(|other| other.len() > module.len() && other.starts_with(module))
    }

    /// For each file the files that it uses.
    fn arrows(&self) -> Arrows {
        let mut arrows = BTreeMap::new();
        for (module, code) in &self.0 {
            let mut used = BTreeSet::new();
            for path in paths(code) {
                used.extend(self.target(module, &path));
            }
            // A folder's root and what lies in the folder belong together: one passes on what the other defines.
            let is_own = |other: &Vec<String>| {
                other.starts_with(module) || module.starts_with(other) && self.passes_on(other)
            };
            used.retain(|other| !is_own(other) && !module.is_empty());
            arrows.insert(module.clone(), used);
        }
        arrows
    }

    /// The file in which a path from a module ends.
    fn target(&self, from: &[String], path: &[String]) -> Option<Vec<String>> {
        let (mut at, mut rest) = if path.first()? == "crate" {
            (Vec::new(), &path[1..])
        } else {
            let up = path.iter().take_while(|segment| *segment == "super").count();
            (from[..from.len().checked_sub(up)?].to_vec(), &path[up..])
        };
        for _ in 0..16 {
            let Some((segment, later)) = rest.split_first() else { break };
            let mut child = at.clone();
            child.push(segment.clone());
            if self.0.contains_key(&child) {
                (at, rest) = (child, later);
                continue;
            }
            let passed = self.0.get(&at).and_then(|code| source_of(code, segment));
            match passed {
                Some(module) => at.extend(module),
                None => break,
            }
        }
        (!at.is_empty()).then_some(at)
    }
}

/// Where a module stands: the place of the longest listed path that it begins with.
fn place(order: &[String], module: &[String]) -> Option<usize> {
    let starts = |listed: &str| module.starts_with(&listed.split("::").map(String::from).collect::<Vec<_>>());
    let listed =
        order.iter().enumerate().flat_map(|(place, names)| names.split(TOGETHER).map(move |n| (place, n)));
    listed.filter(|(_, name)| starts(name)).max_by_key(|(_, name)| name.len()).map(|(place, _)| place)
}

/// The code of a file: without comments, and without what is compiled for tests only.
fn code(text: &str) -> String {
    let (mut out, mut skip) = (String::new(), false);
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let bare = line.trim_start();
        if bare.starts_with("#[cfg(test)]") {
            skip = true;
        } else if skip && !bare.starts_with("#[") && !bare.starts_with("//") {
            // The item that follows: a line that ends it, or its whole block.
            let indent = line.len() - bare.len();
            if !bare.ends_with(';') && !bare.ends_with(',') {
                let close = |line: &str| {
                    line.trim_start().starts_with('}') && line.len() - line.trim_start().len() == indent
                };
                _ = lines.find(|line| close(line));
            }
            skip = false;
        } else if !skip && !bare.starts_with("//") {
            out.push_str(line.split(" // ").next().unwrap_or_default());
            out.push('\n');
        }
    }
    out
}

/// All paths from the crate's root or from a parent, those in braces one by one.
fn paths(code: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let boundary = |at: usize| !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':');
    let mut starts: Vec<usize> =
        ["crate::", "super::"].iter().flat_map(|start| code.match_indices(start).map(|(at, _)| at)).collect();
    starts.sort_unstable();
    for at in starts.into_iter().filter(|at| boundary(*at)) {
        spread(&code[at..], &mut Vec::new(), &mut found);
    }
    found
}

/// Reads a path, follows braces, and returns what is left of the text.
fn spread<'t>(mut text: &'t str, prefix: &mut Vec<String>, found: &mut Vec<Vec<String>>) -> &'t str {
    let depth = prefix.len();
    loop {
        text = text.trim_start();
        if let Some(inner) = text.strip_prefix('{') {
            text = inner;
            loop {
                text = spread(text, prefix, found).trim_start();
                let Some(next) = text.strip_prefix(',') else { break };
                text = next;
            }
            text = text.strip_prefix('}').unwrap_or(text);
            break;
        }
        let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
        if end == 0 {
            break;
        }
        prefix.push(text[..end].to_string());
        text = &text[end..];
        let Some(next) = text.strip_prefix("::") else {
            found.push(prefix.clone());
            break;
        };
        text = next;
    }
    prefix.truncate(depth);
    text
}

/// The module from which a `mod.rs` takes a name that it passes on.
fn source_of(code: &str, name: &str) -> Option<Vec<String>> {
    let uses = code.split("use ").skip(1).filter_map(|rest| rest.split_once(';').map(|(path, _)| path));
    for text in uses {
        let mut found = Vec::new();
        spread(text, &mut Vec::new(), &mut found);
        for mut path in found {
            if path.pop().as_deref() == Some(name) {
                path.retain(|segment| segment != "crate" && segment != "self");
                return Some(path);
            }
        }
    }
    None
}

type Arrows = BTreeMap<Vec<String>, BTreeSet<Vec<String>>>;

/// Groups of files that use each other in circles.
fn circles(arrows: &Arrows) -> BTreeSet<BTreeSet<Vec<String>>> {
    let reached: Arrows = arrows.keys().map(|from| (from.clone(), reached(arrows, from))).collect();
    let mutual = |from: &Vec<String>| {
        let back = |to: &&Vec<String>| reached.get(*to).is_some_and(|from_there| from_there.contains(from));
        reached[from].iter().filter(back).cloned().collect::<BTreeSet<_>>()
    };
    arrows.keys().map(mutual).filter(|group| !group.is_empty()).collect()
}

/// All that can be reached by one arrow or more.
fn reached(arrows: &Arrows, from: &Vec<String>) -> BTreeSet<Vec<String>> {
    let (mut found, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(module) = open.pop() {
        for next in arrows.get(module).into_iter().flatten() {
            if found.insert(next.clone()) {
                open.push(next);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn modules(files: &[(&str, &str)]) -> Modules {
        let path = |name: &str| name.split("::").filter(|s| !s.is_empty()).map(String::from).collect();
        Modules(files.iter().map(|(name, text)| (path(name), code(text))).collect())
    }

    fn findings(files: &[(&str, &str)]) -> Vec<String> {
        modules(files).judge("d2m-x", &["low", "high"].map(String::from), &[])
    }

    const ROOT: (&str, &str) = ("", "mod low;\nmod high;\npub use high::Tower;\n");
    const FOLDER: (&str, &str) = ("low", "mod ground;\npub(crate) use ground::Ground;\n");

    #[test]
    fn the_order_is_read() {
        let text = "x\nOrder of the modules of `d2m-x`: `low`, `high`, `high::top`.\n";
        let names = ["low", "high", "high::top"].map(String::from).to_vec();
        assert_eq!(lists(text, HEADING), [("d2m-x".to_string(), names)]);
    }

    #[test]
    fn arrows_to_what_stands_before_are_right() {
        let high = ("high", "use crate::low::{Ground, ground};\npub struct Tower(Ground);\n");
        assert_eq!(findings(&[ROOT, FOLDER, ("low::ground", "pub struct Ground;\n"), high]), [""; 0]);
    }

    #[test]
    fn each_wrong_arrow_is_found() {
        let high = ("high", "pub struct Tower;\n");
        for wrong in [
            "use crate::high::Tower;",
            "use crate::Tower;",
            "use crate::{\n    Tower,\n};",
            "use super::super::high;",
            "fn f() -> crate::high::Tower {}",
        ] {
            let found = findings(&[ROOT, FOLDER, ("low::ground", wrong), high]);
            assert_eq!(found.len(), 1, "{wrong}: {found:?}");
            assert!(found[0].contains("low::ground uses high"), "{found:?}");
        }
    }

    #[test]
    fn tests_and_comments_have_no_arrows() {
        let text = "//! See crate::high.\n#[cfg(test)]\nuse crate::high::Tower;\n\
            #[cfg(test)]\nmod tests {\n    use crate::high::Tower;\n}\n// crate::high\n";
        assert_eq!(findings(&[ROOT, FOLDER, ("low::ground", text), ("high", "")]), [""; 0]);
    }

    #[test]
    fn modules_that_belong_together_have_one_place() {
        let files = [
            ("", "mod low;\nmod high;\nmod other;\n"),
            ("low", "use crate::high::Tower;"),
            ("high", "use crate::low::Ground;"),
            ("other", "use crate::low::Ground;"),
        ];
        let found = |order: &[&str], allowed: &[&str]| {
            let [order, allowed] =
                [order, allowed].map(|l| l.iter().map(ToString::to_string).collect::<Vec<_>>());
            modules(&files).judge("d2m-x", &order, &allowed)
        };
        assert_eq!(found(&["low + high", "other"], &["high + low"]), [""; 0]);
        assert_eq!(found(&["low + high", "other"], &[]).len(), 1);
        assert_eq!(found(&["other", "low + high"], &["high + low"]).len(), 1);
        assert_eq!(found(&["low", "high", "other"], &["high + low"]).len(), 1);
    }

    #[test]
    fn circles_are_found() {
        let found = findings(&[
            ROOT,
            FOLDER,
            ("high", ""),
            ("low::a", "use super::b::B;"),
            ("low::b", "use super::a::A;"),
        ]);
        assert_eq!(found, ["d2m-x: files that use each other in a circle: low::a, low::b"]);
    }

    #[test]
    fn modules_that_are_not_listed_are_found() {
        assert_eq!(findings(&[ROOT, ("low", ""), ("high", ""), ("else", "")]).len(), 1);
    }
}
