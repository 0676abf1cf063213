//! One page of HTML that shows bodies in motion, without anything that is fetched.

mod flight;
mod picture;
mod run;

pub(crate) use flight::{Flight, flights_of};
pub(crate) use picture::{Mark, Picture};
pub(crate) use run::picture_of_run;
