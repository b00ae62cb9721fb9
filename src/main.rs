//! The `idim` command line: a thin shell over the library, one file per command.

mod commands;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    keep_memory();
    commands::run(commands::Arguments::parse())
}

/// Lets memory that was given back be used again by this process, up to 8 MiB in each arena of the
/// allocator, instead of going to the system and coming back page by page, which every window of a
/// long log would pay for. More would let a long log's memory grow with its length.
///
/// glibc sets what it keeps to twice the largest block that was given back; other allocators
/// keep enough, and nobody touches these pages.
fn keep_memory() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(4 << 20)));
}
