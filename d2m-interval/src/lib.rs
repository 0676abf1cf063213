//! Rigorous, fast, portable interval arithmetic: outward-rounded in every operation, no_std.
