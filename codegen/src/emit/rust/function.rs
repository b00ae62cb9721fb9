//! Bodies of functions in Rust: over a `State<T>` named `x`, for any lane type `T`.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::{comment, parsed};
use crate::describe::identifier::KEYWORDS;
use crate::emit::function::{self, Line, Target};
use crate::emit::language::Language;
use crate::expr::{Function, Input};
use crate::robot::Robot;

/// Rust as a [`Language`].
struct Rust;

impl Language for Rust {
    fn reserved(&self) -> Vec<String> {
        let arguments = ["x", "d", "p", "r", "h", "dh"];
        let words = KEYWORDS.iter().chain(&arguments);
        words.map(|word| (*word).to_owned()).collect()
    }

    fn input(&self, input: Input) -> String {
        match input {
            Input::Q(joint) => format!("x.q[{joint}]"),
            Input::Qd(joint) => format!("x.qd[{joint}]"),
            Input::Qdd(joint) => format!("x.qdd[{joint}]"),
            Input::Slip(joint) => format!("x.slip[{joint}]"),
        }
    }

    fn trig(&self, name: &str) -> String {
        format!("x.{name}")
    }

    fn number(&self, value: f64) -> String {
        format!("T::splat({})", Literal::f64_unsuffixed(value))
    }

    fn call(&self, function: Function, _: &str, x: &str) -> String {
        match function {
            Function::Sign => format!("{x}.sign()"),
            Function::Abs => format!("{x}.abs()"),
            Function::Tanh => format!("{x}.tanh()"),
            Function::Bell => format!("{x}.bell()"),
            Function::Power(p) => {
                let p = Literal::f64_unsuffixed(f64::from_bits(p));
                format!("{x}.abs_power({p})")
            }
            Function::Sine => format!("{x}.sin_cos().0"),
            Function::Cosine => format!("{x}.sin_cos().1"),
        }
    }
}

/// Statements that compute and store all non-zero entries of the targets.
///
/// # Errors
/// A message if an expression is not Rust: a defect of the generator.
pub fn body(robot: &Robot, targets: &[Target]) -> Result<TokenStream, String> {
    let body = function::body(robot, targets, &Rust);
    body.lines.iter().map(line).collect()
}

fn line(line: &Line) -> Result<TokenStream, String> {
    Ok(match line {
        Line::Section(title) => comment::comment(title),
        Line::Constant { name, value } => {
            let name = format_ident!("{name}");
            let value = Literal::f64_unsuffixed(*value);
            quote! { let #name = T::splat(#value); }
        }
        Line::Value { name, value } => {
            let (name, value) = (format_ident!("{name}"), parsed(value)?);
            quote! { let #name = #value; }
        }
        Line::Store {
            argument,
            row,
            column,
            value,
            parameter,
        } => {
            let argument = format_ident!("{argument}");
            let row = row.map(Literal::usize_unsuffixed).into_iter();
            let column = Literal::usize_unsuffixed(*column);
            let value = parsed(value)?;
            let note = comment::note(parameter);
            quote! { #argument #([#row])* [#column] = #value; #note }
        }
    })
}
