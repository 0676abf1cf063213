//! Units and margins of the node tests of one search.

/// Constants of one search for one choice of the wide body. Lengths are in units of that body's tree, times in
/// units of the sub-window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeScale {
    /// Unit of the single body over that of the wide one, a power of two.
    pub(crate) ratio: f64,
    /// One over the unit of the wide body.
    pub(crate) inverse_unit: f64,
    /// Unit of time over the unit of length of the wide body.
    pub(crate) speed_scale: f64,
    /// Unit of time.
    pub(crate) time_unit: f64,
    /// |ω|·(unit of time) of the wide and of the single body, rounded up.
    pub(crate) spin: [f32; 2],
    /// What is added to every margin: the level that counts as contact and the errors of the frame.
    pub(crate) floor: f32,
    /// The same for speeds; infinite where they may overflow.
    pub(crate) speed_floor: f32,
    /// Bound on the acceleration between the bodies.
    pub(crate) acceleration: f32,
}
