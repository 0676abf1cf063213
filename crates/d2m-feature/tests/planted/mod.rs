//! Planted contacts, an independent oracle and a judge: shared by the tests, the accuracy task and the bench.
pub(crate) mod families;
pub(crate) mod judge;
pub(crate) mod oracle;
pub(crate) mod quick;
