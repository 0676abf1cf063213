//! Strips and fans of triangles.

/// The triangles of a strip: every second one is turned round.
pub(super) fn strip(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    corners
        .windows(3)
        .enumerate()
        .map(|(k, c)| if k % 2 == 0 { [c[0], c[1], c[2]] } else { [c[1], c[0], c[2]] })
}

/// The triangles of a fan.
pub(super) fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]])
}
