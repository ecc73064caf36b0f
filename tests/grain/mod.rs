//! Grain over patterns.

mod patterns;
