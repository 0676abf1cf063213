//! Procedural watertight triangle meshes: box, icosphere, torus, knot, gear, screw and nut, and more.
