//! Bodies of functions in Rust: over a `State<T>` named `x`, for any lane type `T`.

use proc_macro2::{Literal, TokenStream, TokenTree};
use quote::{format_ident, quote};

use super::{comment, parsed};
use crate::describe::identifier::KEYWORDS;
use crate::emit::function::{self, Body, Line, Target};
use crate::emit::language::Language;
use crate::expr::{self, Input};
use crate::functions::{Extent, Function, Quantity};
use crate::robot::Robot;

/// Rust as a [`Language`].
struct Rust;

impl Language for Rust {
    fn reserved(&self) -> Vec<String> {
        let arguments = [
            "x",
            "live",
            "parameters",
            "d",
            "p",
            "r",
            "h",
            "dh",
            "tau",
            "m",
            "g",
            "t",
            "j",
        ];
        let words = KEYWORDS.iter().chain(&arguments);
        words.map(|word| (*word).to_owned()).collect()
    }

    fn input(&self, input: Input) -> String {
        match input {
            Input::Q(joint) => format!("x.q[{joint}]"),
            Input::Qd(joint) => format!("x.qd[{joint}]"),
            Input::Qdd(joint) => format!("x.qdd[{joint}]"),
            Input::Slip(joint) => format!("x.slip[{joint}]"),
            Input::Parameter(column) => format!("parameters[{column}]"),
        }
    }

    fn trig(&self, name: &str) -> String {
        format!("x.{name}")
    }

    fn number(&self, value: f64) -> String {
        format!("x.constant({})", Literal::f64_unsuffixed(value))
    }

    fn fuses(&self) -> bool {
        true
    }

    fn times(&self, first: &str, second: &str) -> String {
        format!("{first}.times({second})")
    }

    fn computes_trig(&self) -> bool {
        false
    }

    fn call(&self, function: expr::Function, _: &str, x: &str) -> String {
        match function {
            expr::Function::Sign => format!("{x}.sign()"),
            expr::Function::Abs => format!("{x}.abs()"),
            expr::Function::Tanh => format!("{x}.tanh()"),
            expr::Function::Bell => format!("{x}.bell()"),
            expr::Function::Power(p) => {
                let p = Literal::f64_unsuffixed(f64::from_bits(p));
                format!("{x}.abs_power({p})")
            }
            expr::Function::Sine => format!("{x}.sin_cos().0"),
            expr::Function::Cosine => format!("{x}.sin_cos().1"),
            expr::Function::Reciprocal => format!("{x}.reciprocal()"),
            expr::Function::Root => format!("{x}.root()"),
            expr::Function::RootOfOpposite => format!("(-{x}).root()"),
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
    let types: Vec<(&str, TokenStream)> = targets
        .iter()
        .map(|target| match target.output.is_matrix() {
            true => (target.argument, quote! { [[T; PARAMETERS]; JOINTS] }),
            false => (target.argument, quote! { [T; PARAMETERS] }),
        })
        .collect();
    written(&function::body(robot, targets, &Rust), name, &types)
}

/// The function of a quantity beside the identification models, with its documentation.
///
/// # Errors
/// As [`code`].
pub fn beside(robot: &Robot, function: &Function) -> Result<TokenStream, String> {
    let (name, argument) = match function.quantity {
        Quantity::InverseDynamics => ("inverse_dynamics", "tau"),
        Quantity::MassMatrix => ("mass_matrix", "m"),
        Quantity::Gravity => ("gravity", "g"),
        Quantity::Pose => ("pose", "t"),
        Quantity::Jacobian => ("jacobian", "j"),
    };
    let name = match &function.tip {
        Some(tip) => format!("{name}_{tip}"),
        None => name.to_owned(),
    };
    let (rows, columns) = function.extents();
    let columns = extent(columns);
    let array = match rows.map(extent) {
        Some(rows) => quote! { [[T; #columns]; #rows] },
        None => quote! { [T; #columns] },
    };
    let body = function::body_of(robot, function, argument, &Rust);
    let Code { body, parts } = written(&body, &name, &[(argument, array.clone())])?;
    let parameters = function
        .takes_parameters()
        .then(|| quote! { parameters: &[T; PARAMETERS], });
    let (name, argument) = (format_ident!("{name}"), format_ident!("{argument}"));
    let docs = [
        format!(" {}.", function.summary()),
        String::new(),
        format!(" Writes every entry; {}.", function.unit()),
    ];
    Ok(quote! {
        #(#[doc = #docs])*
        #[inline(always)]
        pub fn #name<T: Lane>(x: &State<T>, #parameters #argument: &mut #array) { #body }

        #parts
    })
}

fn extent(extent: Extent) -> TokenStream {
    match extent {
        Extent::Joints => quote! { JOINTS },
        Extent::Parameters => quote! { PARAMETERS },
        Extent::Number(number) => {
            let number = Literal::usize_unsuffixed(number);
            quote! { #number }
        }
    }
}

fn written(body: &Body, name: &str, types: &[(&str, TokenStream)]) -> Result<Code, String> {
    if let [only] = body.parts.as_slice() {
        return Ok(Code {
            body: only.lines.iter().map(line).collect::<Result<_, _>>()?,
            parts: TokenStream::new(),
        });
    }
    let length = Literal::usize_unsuffixed(body.live);
    let mut code = Code {
        body: quote! { let mut live = [x.constant(0.0); #length]; },
        parts: TokenStream::new(),
    };
    for (index, part) in body.parts.iter().enumerate() {
        let name = format_ident!("{name}_{}", index + 1);
        let reads = |input: &Input| matches!(input, Input::Parameter(_));
        let reads = part.inputs.iter().any(reads);
        let stored = part.outputs();
        let stored = types
            .iter()
            .filter(|(argument, _)| stored.contains(argument));
        let statements: TokenStream = part.lines.iter().map(line).collect::<Result<_, _>>()?;
        // What it takes: name, type, and how the caller hands it on.
        let mut arguments = vec![];
        if names(&statements, "x") {
            arguments.push((format_ident!("x"), quote! { &State<T> }, quote! { x }));
        }
        if reads {
            let name = format_ident!("parameters");
            arguments.push((name, quote! { &[T; PARAMETERS] }, quote! { parameters }));
        }
        if names(&statements, "live") {
            let live = format_ident!("live");
            arguments.push((live, quote! { &mut [T; #length] }, quote! { &mut live }));
        }
        for (argument, array) in stored {
            let name = format_ident!("{argument}");
            arguments.push((name.clone(), quote! { &mut #array }, quote! { &mut *#name }));
        }
        let taken = arguments.iter().map(|(name, _, _)| name);
        let types: Vec<_> = arguments.iter().map(|(_, array, _)| array).collect();
        let given = arguments.iter().map(|(_, _, given)| given);
        code.body
            .extend(quote! { x.q[0].apart(#name, (#(#given,)*)); });
        code.parts.extend(quote! {
            #[allow(non_camel_case_types)]
            struct #name;

            impl<T: Lane> ::idim_runtime::lane::Part<(#(#types,)*)> for #name {
                #[inline(always)]
                fn call(self, (#(#taken,)*): (#(#types,)*)) { #statements }
            }
        });
    }
    Ok(code)
}

/// Whether a word is among the tokens.
fn names(tokens: &TokenStream, word: &str) -> bool {
    tokens.clone().into_iter().any(|token| match token {
        TokenTree::Ident(name) => name == word,
        TokenTree::Group(group) => names(&group.stream(), word),
        _ => false,
    })
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
            quote! { let #name = x.constant(#value); }
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
            let note = (!parameter.is_empty()).then(|| comment::note(parameter));
            quote! { #argument #([#row])* [#column] = #value; #note }
        }
    })
}
