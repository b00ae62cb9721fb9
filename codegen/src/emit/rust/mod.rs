//! The Rust module: header, state, functions, tables, the implementation of the runtime's trait;
//! `prettyplease` sets the type.

pub mod comment;
pub mod function;
pub mod index;
pub mod state;
pub mod tables;

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::function::Target;
use super::signals::signals;
use super::summary::summary;
use crate::robot::{Output, Robot};

/// Version of the contract with the runtime that emitted code asks for.
const ABI: u32 = 3;

/// The Rust source of a robot's module.
///
/// # Errors
/// A message if the tokens do not form a Rust file: a defect of the generator, not of the robot.
pub fn rust(robot: &Robot) -> Result<String, String> {
    let tokens = file(robot)?;
    let file = syn::parse2::<syn::File>(tokens).map_err(|error| {
        format!(
            "the generated module of `{}` is not Rust: {error}",
            robot.mechanism.name
        )
    })?;
    let text = comment::set(&prettyplease::unparse(&file));
    Ok(format!("{}\n{text}", header(robot)))
}

fn header(robot: &Robot) -> String {
    let line = |line: String| format!("// {line}").trim_end().to_owned() + "\n";
    let lines = summary(robot, "change the description and rebuild");
    lines.into_iter().map(line).collect()
}

/// Text of the common emission layer as tokens.
fn parsed(text: &str) -> Result<TokenStream, String> {
    text.parse()
        .map_err(|error| format!("`{text}` is not Rust: {error}"))
}

fn file(robot: &Robot) -> Result<TokenStream, String> {
    let imports = imports();
    let constants = constants(robot);
    let state = state::state(robot)?;
    let functions = functions(robot)?;
    let statics = statics(robot);
    let model = model(robot);
    Ok(quote! { #imports #constants #state #functions #statics #model })
}

fn imports() -> TokenStream {
    let abi = Literal::u32_unsuffixed(ABI);
    quote! {
        use std::borrow::Cow;

        use ::idim_runtime::batch::{self, Motion};
        use ::idim_runtime::knowledge::{Knowledge, Term};
        use ::idim_runtime::lane::Lane;
        use ::idim_runtime::model::{
            Column, ColumnKind, Entry, IdentificationModel, Joint, JointKind, Output, Pattern,
            States,
        };
        use ::idim_runtime::settings;

        const _: () = assert!(
            ::idim_runtime::model::ABI == #abi,
            "generated for another version of idim-runtime: rebuild with a matching idim-codegen"
        );
    }
}

fn constants(robot: &Robot) -> TokenStream {
    let n = Literal::usize_unsuffixed(robot.mechanism.driven);
    let np = Literal::usize_unsuffixed(robot.base.parameters.len());
    let (name, hash) = (&robot.mechanism.name, &robot.description.hash);
    quote! {
        #[doc = " Name of the robot."]
        pub const NAME: &str = #name;
        #[doc = " Number of moving joints, n."]
        pub const JOINTS: usize = #n;
        #[doc = " Number of base parameters, np: the columns of every output."]
        pub const PARAMETERS: usize = #np;
        #[doc = " SHA-256 of the description."]
        pub const DESCRIPTION_HASH: &str = #hash;
    }
}

fn functions(robot: &Robot) -> Result<TokenStream, String> {
    let target = |output, argument| Target { output, argument };
    let code = |name, targets: &[Target]| {
        let code = function::code(robot, name, targets)?;
        Ok::<_, String>((code.body, code.parts))
    };
    let (d, d_parts) = code("explicit", &[target(Output::Explicit, "d")])?;
    let (pr, pr_parts) = code(
        "implicit",
        &[target(Output::Momentum, "p"), target(Output::Rest, "r")],
    )?;
    let (h, h_parts) = code("energy", &[target(Output::Energy, "h")])?;
    let (dh, dh_parts) = code("power", &[target(Output::Power, "dh")])?;
    let beside: TokenStream = (robot.functions.iter())
        .map(|function| function::beside(robot, function))
        .collect::<Result<_, _>>()?;
    Ok(quote! {
        #[doc = " D of the explicit model tau = D(q, qd, qdd) X (Gautier 1996, eq. 5)."]
        #[doc = ""]
        #[doc = " Writes the entries that are not always zero; `d[joint][column]`, N m or N per unit"]
        #[doc = " of the parameter."]
        #[inline(always)]
        pub fn explicit<T: Lane>(x: &State<T>, d: &mut [[T; PARAMETERS]; JOINTS]) { #d }

        #d_parts

        #[doc = " P and R of the implicit model tau = d/dt(P X) + R X (Gautier 1996, eqs. 7-9)."]
        #[doc = ""]
        #[doc = " Writes the entries that are not always zero; needs no acceleration."]
        #[inline(always)]
        pub fn implicit<T: Lane>(
            x: &State<T>,
            p: &mut [[T; PARAMETERS]; JOINTS],
            r: &mut [[T; PARAMETERS]; JOINTS],
        ) { #pr }

        #pr_parts

        #[doc = " h, the energies: qd . tau = (dh/dt) X + the powers (Gautier 1996, eq. 10), J."]
        #[inline(always)]
        pub fn energy<T: Lane>(x: &State<T>, h: &mut [T; PARAMETERS]) { #h }

        #h_parts

        #[doc = " dh of the columns that have no energy of the state (friction), W."]
        #[inline(always)]
        pub fn power<T: Lane>(x: &State<T>, dh: &mut [T; PARAMETERS]) { #dh }

        #dh_parts

        #beside
    })
}

/// Upper-case name of the tables of an output.
fn table_name(output: Output) -> &'static str {
    match output {
        Output::Explicit => "EXPLICIT",
        Output::Momentum => "MOMENTUM",
        Output::Rest => "REST",
        Output::Energy => "ENERGY",
        Output::Power => "POWER",
    }
}

fn statics(robot: &Robot) -> TokenStream {
    let (joints, columns) = (tables::joints(robot), tables::columns(robot));
    let (settings, knowledge) = (tables::settings(robot), tables::knowledge(robot));
    let mut patterns = TokenStream::new();
    for output in Output::ALL {
        let signals = signals(robot, output);
        let name = format_ident!("{}", table_name(output));
        let first = format_ident!("{}_SIGNALS", table_name(output));
        let (pattern, places) = (tables::pattern(&signals), tables::first(&signals));
        let count = Literal::usize_unsuffixed(signals.first.len());
        patterns.extend(quote! {
            static #name: Pattern = #pattern;
            static #first: [(usize, usize); #count] = #places;
        });
    }
    quote! {
        #[doc = " The moving joints, in the order of q."]
        pub static JOINT_TABLE: [Joint; JOINTS] = #joints;

        #[doc = " The parameters, in the order of the columns of every output."]
        pub static COLUMNS: [Column; PARAMETERS] = #columns;

        #[doc = " The robot's own defaults for identification."]
        pub static SETTINGS: settings::Settings = #settings;

        const fn term(column: usize, link: usize, parameter: usize, factor: f64) -> Term {
            Term { column, link, parameter, factor }
        }

        #[doc = " What the description knows of the parameters."]
        pub static KNOWLEDGE: Knowledge = #knowledge;

        const fn entry(row: usize, column: usize, signal: usize) -> Entry {
            Entry { row, column, signal }
        }

        #patterns
    }
}

/// The trait's list of joints with a presliding state; nothing for a robot without.
fn presliding(robot: &Robot) -> TokenStream {
    let joints: Vec<TokenStream> = robot
        .mechanism
        .presliding()
        .map(|(joint, zs)| {
            let joint = Literal::usize_unsuffixed(joint);
            let zs = Literal::f64_unsuffixed(zs);
            quote! { ::idim_runtime::model::Presliding { joint: #joint, zs: #zs } }
        })
        .collect();
    if joints.is_empty() {
        return TokenStream::new();
    }
    quote! {
        fn presliding(&self) -> &[::idim_runtime::model::Presliding] {
            &[#(#joints),*]
        }
    }
}

fn model(robot: &Robot) -> TokenStream {
    let name = &robot.mechanism.name;
    let doc = format!(" `{name}` as the runtime sees it.");
    let memory = presliding(robot);
    let state = match memory.is_empty() {
        true => quote! { State::new(motion.q, motion.qd, motion.qdd) },
        false => quote! { State::new(motion.q, motion.qd, motion.qdd).with_slip(motion.slip) },
    };
    quote! {
        #[doc = #doc]
        #[derive(Clone, Copy, Debug, Default)]
        pub struct Model;

        impl IdentificationModel for Model {
            fn name(&self) -> &str {
                NAME
            }
            fn joints(&self) -> &[Joint] {
                &JOINT_TABLE
            }
            fn columns(&self) -> &[Column] {
                &COLUMNS
            }
            fn pattern(&self, output: Output) -> &Pattern {
                match output {
                    Output::Explicit => &EXPLICIT,
                    Output::Momentum => &MOMENTUM,
                    Output::Rest => &REST,
                    Output::Energy => &ENERGY,
                    Output::Power => &POWER,
                }
            }
            fn settings(&self) -> &settings::Settings {
                &SETTINGS
            }
            fn knowledge(&self) -> &Knowledge {
                &KNOWLEDGE
            }
            #memory
            fn evaluate(&self, output: Output, states: &States<'_>, signals: &mut [f64]) {
                let places: &[(usize, usize)] = match output {
                    Output::Explicit => &EXPLICIT_SIGNALS,
                    Output::Momentum => &MOMENTUM_SIGNALS,
                    Output::Rest => &REST_SIGNALS,
                    Output::Energy => &ENERGY_SIGNALS,
                    Output::Power => &POWER_SIGNALS,
                };
                batch::evaluate::<Model, JOINTS, PARAMETERS>(output, places, states, signals);
            }
        }

        impl batch::Functions<JOINTS, PARAMETERS> for Model {
            #[inline(always)]
            fn explicit<T: Lane>(motion: Motion<T, JOINTS>, d: &mut [[T; PARAMETERS]; JOINTS]) {
                explicit(&#state, d);
            }
            #[inline(always)]
            fn implicit<T: Lane>(
                motion: Motion<T, JOINTS>,
                p: &mut [[T; PARAMETERS]; JOINTS],
                r: &mut [[T; PARAMETERS]; JOINTS],
            ) {
                implicit(&#state, p, r);
            }
            #[inline(always)]
            fn energy<T: Lane>(motion: Motion<T, JOINTS>, h: &mut [T; PARAMETERS]) {
                energy(&#state, h);
            }
            #[inline(always)]
            fn power<T: Lane>(motion: Motion<T, JOINTS>, dh: &mut [T; PARAMETERS]) {
                power(&#state, dh);
            }
        }
    }
}
