//! The pages of the guide and of the repository's README: as documentation tests their examples are compiled and run. A crate of its
//! own, so that the package of no library needs files outside of it.
#![forbid(unsafe_code)]

/// A type for each page.
macro_rules! pages {
    ($($name:ident: $path:literal),* $(,)?) => {
        $(
            #[cfg(doctest)]
            #[doc = include_str!(concat!("../../../", $path))]
            pub struct $name;
        )*
    };
}

pages! {
    Readme: "README.md",
    FiveMinutes: "docs/guide/README.md",
    Certified: "docs/guide/certified.md",
    OnePair: "docs/guide/one-pair.md",
    View: "docs/guide/view.md",
    Meshes: "docs/guide/meshes.md",
    Motions: "docs/guide/motions.md",
    Tolerances: "docs/guide/tolerances.md",
    HowNear: "docs/guide/how-near.md",
    Scenes: "docs/guide/scenes.md",
    Simulation: "docs/guide/simulation.md",
    Budgets: "docs/guide/budgets.md",
    Verification: "docs/guide/verification.md",
    Python: "docs/guide/python.md",
    JavaScript: "docs/guide/javascript.md",
    Crates: "docs/guide/crates.md",
    Results: "docs/guide/results.md",
    Troubleshooting: "docs/guide/troubleshooting.md",
    HowItWorks: "docs/guide/how-it-works.md",
    Migrating: "docs/guide/migrating.md",
}
