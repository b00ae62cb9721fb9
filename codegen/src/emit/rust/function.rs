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
        let arguments = ["x", "live", "d", "p", "r", "h", "dh"];
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

    fn divides(&self) -> bool {
        true
    }

    fn computes_trig(&self) -> bool {
        false
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

/// A function: what stands between its braces, and the functions of its parts if it is long.
#[derive(Debug)]
pub struct Code {
    /// Statements, or the calls of the parts.
    pub body: TokenStream,
    /// The parts.
    pub parts: TokenStream,
}

/// Computes and stores all non-zero entries of the targets, in a function of the given name.
///
/// # Errors
/// A message if an expression is not Rust: a defect of the generator.
pub fn code(robot: &Robot, name: &str, targets: &[Target]) -> Result<Code, String> {
    let body = function::body(robot, targets, &Rust);
    if let [only] = body.parts.as_slice() {
        return Ok(Code {
            body: only.lines.iter().map(line).collect::<Result<_, _>>()?,
            parts: TokenStream::new(),
        });
    }
    let length = Literal::usize_unsuffixed(body.live);
    let mut code = Code {
        body: quote! { let mut live = [T::splat(0.0); #length]; },
        parts: TokenStream::new(),
    };
    for (index, part) in body.parts.iter().enumerate() {
        let name = format_ident!("{name}_{}", index + 1);
        let state = part.reads_state.then(|| quote! { x, });
        let taken = part.reads_state.then(|| quote! { x: &State<T>, });
        let outputs = part.outputs().into_iter().map(|argument| {
            let matrix = targets
                .iter()
                .any(|t| t.argument == argument && t.output.is_matrix());
            let argument = format_ident!("{argument}");
            let given = quote! { #argument };
            match matrix {
                true => (given, quote! { #argument: &mut [[T; PARAMETERS]; JOINTS] }),
                false => (given, quote! { #argument: &mut [T; PARAMETERS] }),
            }
        });
        let (given, outputs): (Vec<_>, Vec<_>) = outputs.unzip();
        let statements: TokenStream = part.lines.iter().map(line).collect::<Result<_, _>>()?;
        code.body
            .extend(quote! { #name(#state &mut live, #(#given),*); });
        code.parts.extend(quote! {
            #[inline(never)]
            fn #name<T: Lane>(#taken live: &mut [T; #length], #(#outputs),*) { #statements }
        });
    }
    Ok(code)
}

fn line(line: &Line) -> Result<TokenStream, String> {
    Ok(match line {
        Line::Section(title) => comment::comment(title),
        Line::Load { name, place } => {
            let (name, place) = (format_ident!("{name}"), Literal::usize_unsuffixed(*place));
            quote! { let #name = live[#place]; }
        }
        Line::Keep { name, place } => {
            let (name, place) = (format_ident!("{name}"), Literal::usize_unsuffixed(*place));
            quote! { live[#place] = #name; }
        }
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
