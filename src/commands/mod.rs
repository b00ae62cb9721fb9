//! What the command line offers, and how a command ends.
//!
//! Exit status: 0 done, 1 could not do it (message on standard error), 2 bad usage.

mod demo;
mod describe;
mod diagnose;
mod excite;
mod export;
mod failure;
mod fits;
mod gains;
mod generate;
mod identify;
mod output;
mod predictions;
mod progress;
mod robot;
mod simulate;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

pub use failure::Failure;

/// Identify robot dynamics: from a description and a measured log to base parameters with error
/// bars, by three filtered models side by side.
#[derive(Debug, Parser)]
#[command(name = "idim", version, propagate_version = true)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// The paper's SCARA, simulated and identified by three models; no arguments, no files.
    Demo(demo::Arguments),
    /// Mechanism, base parameters with their relations, operation counts of a robot.
    Describe(describe::Arguments),
    /// The effect that a robot's model lacks, found in its logs, and the gap that it closes.
    Diagnose(Box<diagnose::Arguments>),
    /// A motion along which the parameters of a robot can be told apart, within its limits.
    Excite(Box<excite::Arguments>),
    /// Identified, physically consistent inertias in a URDF.
    Export(export::Arguments),
    /// The specialised code of a robot.
    Generate(generate::Arguments),
    /// Parameters of a robot from measured logs, with statistics and validation.
    Identify(Box<identify::Arguments>),
    /// Motion of a robot with given parameters: closed loop along a reference, or open loop.
    Simulate(simulate::Arguments),
}

/// Runs a command and shows what went wrong.
pub fn run(arguments: Arguments) -> ExitCode {
    let result = match arguments.command {
        Command::Demo(arguments) => demo::run(&arguments),
        Command::Describe(arguments) => describe::run(&arguments),
        Command::Diagnose(arguments) => diagnose::run(&arguments),
        Command::Excite(arguments) => excite::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Generate(arguments) => generate::run(&arguments),
        Command::Identify(arguments) => identify::run(&arguments),
        Command::Simulate(arguments) => simulate::run(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.show(),
    }
}
