//! All of a window: sub-window after sub-window, on several threads, or spans of many that are divided where that is needed.

mod over_time;
#[cfg(feature = "rayon")]
mod parallel;
mod time_split;
