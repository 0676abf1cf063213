//! One module for each command.

pub(crate) mod batch;
pub(crate) mod clearance;
pub(crate) mod collide;
pub(crate) mod demo;
pub(crate) mod distance;
pub(crate) mod features;
pub(crate) mod info;
pub(crate) mod manual;
pub(crate) mod proximities;
pub(crate) mod robot;
mod robot_proof;
pub(crate) mod scene;
mod scene_question;
pub(crate) mod simulate;
pub(crate) mod spans;
pub(crate) mod toc;
pub(crate) mod tree;
pub(crate) mod verify;
pub(crate) mod view;
