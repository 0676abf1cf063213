//! Planted contacts of single feature pairs, an independent oracle and a judge.
pub mod families;
pub mod judge;
pub mod oracle;
pub mod quick;
pub mod twins;
