//! Capoeira mode: the broad phase alone.

use super::traverse::Search;
use d2m_bvh::Mode;

impl Search<'_> {
    /// Does the search stop at leaf spheres?
    ///
    /// The start of the overlap of two leaf spheres then stands for the contact of their content. It is a certified
    /// *early* time: nothing touches before it. It is neither a certified contact nor a certified miss: the content of
    /// the leaves may pass without touching, while the spheres meet. The distance left is bounded: the two leaf
    /// spheres touch at that time (or may, as far as one evaluation of the parabola shows), so the bodies are at most
    /// the sum of the two spheres' diameters apart, 2·(√3/32 + √3/32) radii for leaves of the smallest rib.
    pub(crate) const fn stops_at_leaves(mode: Mode) -> bool {
        matches!(mode, Mode::Capoeira)
    }
}
