//! Many faults in one build: a function that holds a fault gets the spoilt body beside the right one, and the
//! environment of the program says which of them runs (mutant schemata: Untch, Offutt and Harrold 1993,
//! <https://doi.org/10.1145/154183.154265>).
use std::fmt::Write;
use std::ops::Range;
use syn::visit::{self, Visit};
use syn::{Block, ImplItemFn, ItemFn, ReturnType, Signature, TraitItemFn, TypeImplTrait};

/// The variable of the environment that holds the number of the fault to be made.
pub(super) const VARIABLE: &str = "D2M_FAULT";

/// What the root module of a crate with switches ends with, whether the crate uses the standard library or not.
/// Spoilt bodies are closures that are not inlined: with the right ones, inlined into each other, they would be many.
pub(super) fn reader() -> String {
    format!(
        "
#[inline]
pub(crate) fn has_fault(number: usize) -> bool {{
    extern crate std as host;
    static MADE: host::sync::LazyLock<Option<usize>> =
        host::sync::LazyLock::new(|| host::env::var(\"{VARIABLE}\").ok()?.parse().ok());
    *MADE == Some(number)
}}
#[cold]
#[inline(never)]
pub(crate) fn spoilt<T>(body: impl FnOnce() -> T) -> T {{
    body()
}}
"
    )
}

/// A text that becomes another one.
#[derive(Clone, Copy)]
pub(super) struct Fault<'a> {
    pub(super) number: usize,
    pub(super) from: &'a str,
    pub(super) to: &'a str,
}

/// A file with switches.
#[derive(Debug)]
pub(super) struct Switched {
    pub(super) text: String,
    functions: Vec<Function>,
}

/// Where a function with switches lies in the text, and each of its spoilt bodies.
#[derive(Debug)]
struct Function {
    place: Range<usize>,
    spoilt: Vec<Spoilt>,
}

#[derive(Debug)]
struct Spoilt {
    number: usize,
    place: Range<usize>,
}

impl Switched {
    /// The file with every fault that can have a switch. Those that cannot have their texts outside of bodies, or in
    /// a body that the compiler evaluates or of which the type is the body's own.
    pub(super) fn new(right: &str, faults: &[Fault<'_>]) -> Self {
        let mut switched = Self { text: String::new(), functions: Vec::new() };
        let mut copied = 0;
        for Body { place, output } in bodies(right) {
            let spoilt = |fault: &Fault<'_>| Some((fault.number, spoil(right, &place, fault)?));
            let spoilt: Vec<(usize, String)> = faults.iter().filter_map(spoilt).collect();
            if !spoilt.is_empty() {
                switched.text.push_str(&right[copied..place.start]);
                switched.add([&right[place.clone()], right[output].trim()], &spoilt);
                copied = place.end;
            }
        }
        switched.text.push_str(&right[copied..]);
        switched
    }

    fn add(&mut self, [right, output]: [&str; 2], spoilt: &[(usize, String)]) {
        let text = &mut self.text;
        let mut function = Function { place: text.len()..text.len(), spoilt: Vec::new() };
        let mut word = "{ if";
        for (number, body) in spoilt {
            let _ = write!(text, "{word} crate::has_fault({number}) {{ crate::spoilt(move || {output} ");
            let start = text.len();
            text.push_str(body);
            function.spoilt.push(Spoilt { number: *number, place: start..text.len() });
            text.push_str(") }");
            word = " else if";
        }
        let _ = write!(text, " else {right} }}");
        function.place.end = text.len();
        self.functions.push(function);
    }

    /// The faults that have a switch.
    pub(super) fn numbers(&self) -> impl Iterator<Item = usize> {
        self.functions.iter().flat_map(|function| function.spoilt.iter().map(|spoilt| spoilt.number))
    }

    /// The faults to which an error at a place of the text may be due: the one in whose body it lies, or all of the
    /// function.
    pub(super) fn numbers_at(&self, place: &Range<usize>) -> Vec<usize> {
        let holds = |outer: &Range<usize>| outer.start <= place.start && place.end <= outer.end;
        let Some(function) = self.functions.iter().find(|function| holds(&function.place)) else {
            return Vec::new();
        };
        let one = function.spoilt.iter().position(|spoilt| holds(&spoilt.place));
        let named = one.map_or(&function.spoilt[..], |one| &function.spoilt[one..=one]);
        named.iter().map(|spoilt| spoilt.number).collect()
    }
}

/// The body with the fault, if it holds its text and still is a block then.
fn spoil(right: &str, body: &Range<usize>, fault: &Fault<'_>) -> Option<String> {
    let start = right.find(fault.from)?;
    let end = start + fault.from.len();
    if start < body.start || body.end < end {
        return None;
    }
    let block = format!("{}{}{}", &right[body.start..start], fault.to, &right[end..body.end]);
    syn::parse_str::<Block>(&block).is_ok().then_some(block)
}

/// The bodies that can be one branch of two, from the first to the last. What lies inside of one is part of it.
fn bodies(text: &str) -> Vec<Body> {
    let mut bodies = Bodies(Vec::new());
    if let Ok(file) = syn::parse_file(text) {
        bodies.visit_file(&file);
    }
    bodies.0
}

/// Where the block of a function lies, and where it says what the function returns.
struct Body {
    place: Range<usize>,
    output: Range<usize>,
}

struct Bodies(Vec<Body>);

impl Bodies {
    fn add(&mut self, signature: &Signature, body: &Block) {
        if signature.constness.is_none() && !is_opaque(&signature.output) {
            let braces = body.brace_token.span;
            let place = braces.open().byte_range().start..braces.close().byte_range().end;
            let clause = signature.generics.where_clause.as_ref();
            let end = clause.map_or(place.start, |clause| clause.where_token.span.byte_range().start);
            let output = match &signature.output {
                ReturnType::Default => end..end,
                ReturnType::Type(arrow, _) => arrow.spans[0].byte_range().start..end,
            };
            self.0.push(Body { place, output });
        }
    }
}

impl<'ast> Visit<'ast> for Bodies {
    fn visit_item_fn(&mut self, function: &'ast ItemFn) {
        self.add(&function.sig, &function.block);
    }

    fn visit_impl_item_fn(&mut self, function: &'ast ImplItemFn) {
        self.add(&function.sig, &function.block);
    }

    fn visit_trait_item_fn(&mut self, function: &'ast TraitItemFn) {
        if let Some(body) = &function.default {
            self.add(&function.sig, body);
        }
    }
}

/// Two bodies of a function that returns an `impl Trait` have two types.
fn is_opaque(output: &ReturnType) -> bool {
    struct Opaque(bool);
    impl<'ast> Visit<'ast> for Opaque {
        fn visit_type_impl_trait(&mut self, _: &'ast TypeImplTrait) {
            self.0 = true;
        }
    }
    let mut opaque = Opaque(false);
    visit::visit_return_type(&mut opaque, output);
    opaque.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn switched(right: &str, changes: &[[&str; 2]]) -> Switched {
        let faults: Vec<Fault<'_>> = changes
            .iter()
            .enumerate()
            .map(|(number, &[from, to])| Fault { number: number + 1, from, to })
            .collect();
        Switched::new(right, &faults)
    }

    #[test]
    fn a_function_has_both_bodies() {
        let one = switched("fn f(x: f64) -> f64 { x + 1.0 }\n", &[["1.0", "2.0"]]);
        let body =
            "{ if crate::has_fault(1) { crate::spoilt(move || -> f64 { x + 2.0 }) } else { x + 1.0 } }";
        assert_eq!(one.text, format!("fn f(x: f64) -> f64 {body}\n"));
    }

    #[test]
    fn several_faults_of_a_function_are_a_chain() {
        let two = switched("const K: u8 = 1;\nfn f() { a(); b() }", &[["a()", "()"], ["; b()", ""]]);
        let chain = "{ if crate::has_fault(1) { crate::spoilt(move ||  { (); b() }) } \
            else if crate::has_fault(2) { crate::spoilt(move ||  { a() }) } else { a(); b() } }";
        assert_eq!(two.text, format!("const K: u8 = 1;\nfn f() {chain}"));
        assert_eq!(two.numbers().collect::<Vec<_>>(), [1, 2]);
    }

    #[test]
    fn methods_closures_and_functions_inside_of_functions_have_switches() {
        // Places are bytes, not characters.
        let right =
            "/* π */ impl A { fn f(&self) -> u8 { let g = |x| { x + 1 }; const fn h() -> u8 { 2 } g(h()) } }
            trait B { fn one<T>(&self) -> u8 where T: Copy { 3 } fn two(&self); }
            mod c { fn d() -> u8 { 4 } }";
        let all = switched(right, &[["x + 1", "x"], ["{ 2 }", "{ 5 }"], ["{ 3 }", "{ 6 }"], ["4", "7"]]);
        assert_eq!(all.numbers().collect::<Vec<_>>(), [1, 2, 3, 4]);
        assert!(all.text.contains("{ crate::spoilt(move || -> u8 { 6 }) } else { 3 }"));
        assert!(all.text.contains("let g = |x| { x }; const fn h() -> u8 { 2 }"));
    }

    #[test]
    fn what_is_no_branch_of_two_has_no_switch() {
        let right = "const K: u8 = 1; const fn f() -> u8 { 2 } fn g() -> impl Fn() -> u8 { || 3 }
            fn h(x: u8) -> u8 { if x > 4 { 5 } else { 6 } } macro_rules! m { () => { 7 } }";
        let faults = [
            ["1", "0"],
            ["2", "0"],
            ["|| 3", "|| 0"],
            ["x: u8", "y: u8"],
            ["if x > 4 {", ""],
            ["7", "0"],
            ["fn h(x: u8) -> u8 { if", "fn h(x: u8) -> u8 { if !"],
        ];
        let none = switched(right, &faults);
        assert_eq!(none.text, right);
        assert_eq!(none.numbers().count(), 0);
    }

    #[test]
    fn an_error_is_due_to_its_body_or_to_all_of_its_function() {
        let two =
            switched("fn f() { a(); b() } fn g() { c() }", &[["a()", "x()"], ["b()", "y()"], ["c()", "z()"]]);
        let at = |text: &str| {
            let start = two.text.rfind(text).unwrap();
            two.numbers_at(&(start..start + text.len()))
        };
        assert_eq!(at("x()"), [1]);
        assert_eq!(at("y()"), [2]);
        assert_eq!(at("{ a(); b() }"), [1, 2]);
        assert_eq!(at("c()"), [3]);
        assert_eq!(at("fn g"), [0; 0]);
    }
}
