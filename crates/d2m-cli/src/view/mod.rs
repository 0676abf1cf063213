//! One page of HTML that shows bodies in motion, without anything that is fetched.

mod flight;
mod picture;
mod run;
mod scene;

pub(crate) use flight::{Flight, flights_of};
pub(crate) use picture::{Mark, Picture};
pub(crate) use run::picture_of_run;
pub(crate) use scene::picture_of_scene;
