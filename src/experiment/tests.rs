//! Tests of the parts of experiments.
