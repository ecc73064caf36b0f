//! The tests of the whole program: scenes in, pictures and diagnostics out.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod angles;
mod arrows;
mod bad_input;
mod browser;
mod cases;
mod cli;
mod codes;
mod darkness;
mod determinism;
mod documents;
mod examples;
mod experiment;
mod gallery;
mod grain;
mod ink;
mod metrics;
mod paper;
mod preview;
mod preview_server;
mod repeat;
mod statistics;
mod support;
