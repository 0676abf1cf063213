//! First roots with proof: second-order inclusion functions, BBOI, IRD, HRFOI, interval Newton, path-jet isolator.
