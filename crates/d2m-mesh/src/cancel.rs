use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Numbers of cancellers that are gone, for the next ones.
static FREE: Mutex<Vec<&'static AtomicU64>> = Mutex::new(Vec::new());

/// Ends queries from another thread.
///
/// Queries get its [`flag`](Self::flag) with their [`Budget`](crate::Budget) and read it as often as the clock, every few hundred
/// node tests. One that is cancelled answers as if its time were over: what it proved until then holds. Once cancelled is
/// cancelled for good; dropping the canceller cancels, too.
///
/// ```
/// use d2m_mesh::{Budget, Canceller, MeshTree, Posed, Solid, TriMesh, collide_within};
/// use d2m_motion::Pose;
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = MeshTree::new(mesh);
/// let raised = Posed::new(&tree, Pose { translation: DVec3::Z * 0.5, ..Pose::IDENTITY });
/// let canceller = Canceller::new();
/// let budget = Budget::UNLIMITED.with_cancel(canceller.flag());
/// let ask = || collide_within(Posed::at_rest(&tree), raised, Solid::Filled, &budget);
/// assert_eq!(ask()?, Some(true));
/// std::thread::scope(|scope| scope.spawn(|| canceller.cancel()).join()).unwrap();
/// assert_eq!(ask()?, None); // not decided
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Canceller {
    flag: CancelFlag,
}

/// Says whether a [`Canceller`] has cancelled. Options are plain values that are copied, so a flag is one, too: the number of its
/// canceller, and where that stands while it has not cancelled.
///
/// ```
/// let canceller = d2m_mesh::Canceller::new();
/// let flag = canceller.flag();
/// assert!(!flag.is_cancelled());
/// canceller.cancel();
/// assert!(flag.is_cancelled());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct CancelFlag {
    place: &'static AtomicU64,
    number: u64,
}

impl Canceller {
    /// Nothing is cancelled yet.
    pub fn new() -> Self {
        let free = FREE.lock().unwrap_or_else(PoisonError::into_inner).pop();
        // There are as many places as there ever were cancellers at one time.
        let place = free.unwrap_or_else(|| Box::leak(Box::new(AtomicU64::new(0))));
        Self { flag: CancelFlag { place, number: place.load(Ordering::Relaxed) } }
    }

    /// What the queries get.
    pub const fn flag(&self) -> CancelFlag {
        self.flag
    }

    /// Ends the queries that have the flag, and those that will. Safe in a signal handler: one store.
    pub fn cancel(&self) {
        self.flag.place.store(self.flag.number.wrapping_add(1), Ordering::Relaxed);
    }
}

impl Default for Canceller {
    fn default() -> Self {
        Self::new()
    }
}

impl Drop for Canceller {
    fn drop(&mut self) {
        // Flags that are still about have another number than any later canceller of this place.
        self.cancel();
        FREE.lock().unwrap_or_else(PoisonError::into_inner).push(self.flag.place);
    }
}

impl CancelFlag {
    /// Has its canceller cancelled, or is it gone?
    #[inline(always)]
    pub fn is_cancelled(&self) -> bool {
        self.place.load(Ordering::Relaxed) != self.number
    }
}

impl PartialEq for CancelFlag {
    fn eq(&self, other: &Self) -> bool {
        core::ptr::eq(self.place, other.place) && self.number == other.number
    }
}

impl Eq for CancelFlag {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flag_belongs_to_one_canceller() {
        let (first, second) = (Canceller::new(), Canceller::new());
        let flags = [first.flag(), second.flag()];
        assert_ne!(flags[0], flags[1]);
        second.cancel();
        assert_eq!(flags.map(|flag| flag.is_cancelled()), [false, true]);
        drop((first, second));
        let later = [(); 4].map(|()| Canceller::new());
        assert_eq!(flags.map(|flag| flag.is_cancelled()), [true, true]);
        assert!(later.iter().all(|canceller| !canceller.flag().is_cancelled()));
        assert!(later.iter().all(|canceller| !flags.contains(&canceller.flag())));
    }
}
