//! Rigid motions over time with certified enclosures: linear, screw, keyframes, and an open trait.
