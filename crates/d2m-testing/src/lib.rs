#![forbid(unsafe_code)]
//! What the tests, the benches and the tasks of this workspace share. Not published.
//!
//! **Invariant:** nothing here shares code with what it judges, but the definition of a motion and the types of questions
//! and answers. Draws from a seed are the same on every machine and in every release.

#[cfg(any(feature = "planted", feature = "scenes"))]
mod opaque;
mod planted_touch;
mod random;
#[cfg(feature = "scenes")]
mod sharp_scene;
#[cfg(feature = "scenes")]
mod small_scene;
mod surface;
mod torus;
mod xoshiro;

#[cfg(feature = "planted")]
pub mod big;
#[cfg(feature = "elementary")]
pub mod elementary;
#[cfg(feature = "planted")]
pub mod fixed;
#[cfg(feature = "planted")]
pub mod planted;

#[cfg(any(feature = "planted", feature = "scenes"))]
pub use opaque::{Blurred, Bounded, CountedStates, Opaque, OpaqueWithState};
pub use planted_touch::{PlantedTouch, Touch};
pub use random::{Draw, KnuthRandom, Random};
#[cfg(feature = "scenes")]
pub use sharp_scene::{SharpFamily, SharpScene};
#[cfg(feature = "scenes")]
pub use small_scene::SmallScene;
pub use surface::Surface;
pub use xoshiro::Xoshiro256;
