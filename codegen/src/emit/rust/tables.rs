//! The tables beside the functions: joints, columns, patterns, settings.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use crate::derive::ParameterKind;
use crate::describe::{EdgesSpec, FreedomSpec, VelocitySpec, WeightsSpec};
use crate::emit::signals::Signals;
use crate::knowledge::Knowledge;
use crate::mechanism::JointKind;
use crate::robot::Robot;

/// `[Joint; n]`.
pub fn joints(robot: &Robot) -> TokenStream {
    let joints = robot.mechanism.driven().iter().map(|joint| {
        let name = &joint.name;
        let kind = match joint.kind {
            JointKind::Revolute => quote! { JointKind::Revolute },
            JointKind::Prismatic => quote! { JointKind::Prismatic },
        };
        quote! { Joint { name: Cow::Borrowed(#name), kind: #kind } }
    });
    quote! { [#(#joints),*] }
}

/// `[Column; np]`.
pub fn columns(robot: &Robot) -> TokenStream {
    let columns = robot.base.parameters.iter().map(|parameter| {
        let (name, unit, meaning) = (&parameter.name, &parameter.unit, &parameter.meaning);
        let relation = parameter.relation_text();
        let joint = Literal::usize_unsuffixed(parameter.link + 1);
        let kind = match parameter.kind {
            ParameterKind::Inertial(_) => quote! { Inertial },
            ParameterKind::Drive => quote! { Drive },
            ParameterKind::Friction => quote! { Friction },
            ParameterKind::Effect => quote! { Effect },
        };
        quote! {
            Column {
                name: Cow::Borrowed(#name),
                unit: Cow::Borrowed(#unit),
                joint: #joint,
                kind: ColumnKind::#kind,
                meaning: Cow::Borrowed(#meaning),
                relation: Cow::Borrowed(#relation),
            }
        }
    });
    quote! { [#(#columns),*] }
}

/// `Pattern { .. }` of an output.
pub fn pattern(signals: &Signals) -> TokenStream {
    let entries = signals.entries.iter().map(|&(row, column, signal)| {
        let [row, column, signal] = [row, column, signal].map(Literal::usize_unsuffixed);
        quote! { entry(#row, #column, #signal) }
    });
    let count = Literal::usize_unsuffixed(signals.first.len());
    quote! { Pattern { entries: Cow::Borrowed(&[#(#entries),*]), signals: #count } }
}

/// `[(row, column); signals]`.
pub fn first(signals: &Signals) -> TokenStream {
    let places = signals.first.iter().map(|&(row, column)| {
        let [row, column] = [row, column].map(Literal::usize_unsuffixed);
        quote! { (#row, #column) }
    });
    quote! { [#(#places),*] }
}

/// `Settings { .. }`.
pub fn settings(robot: &Robot) -> TokenStream {
    let spec = &robot.description.identify;
    let number = |value: Option<f64>| option(value.map(Literal::f64_unsuffixed));
    let count = |value: Option<usize>| option(value.map(Literal::usize_unsuffixed));
    let (fq_hz, order, nd, trim) = (
        number(spec.fq_hz),
        count(spec.order),
        count(spec.nd),
        count(spec.trim),
    );
    let border = option(spec.border.map(|(start, end)| {
        let [start, end] = [start, end].map(Literal::usize_unsuffixed);
        quote! { (#start, #end) }
    }));
    let edges = option(spec.edges.map(|edges| match edges {
        EdgesSpec::Matlab => quote! { settings::Edges::Matlab },
        EdgesSpec::Scipy => quote! { settings::Edges::Scipy },
    }));
    let weights = option(spec.weights.map(|weights| match weights {
        WeightsSpec::None => quote! { settings::Weights::None },
        WeightsSpec::Joint => quote! { settings::Weights::Joint },
        WeightsSpec::Robust => quote! { settings::Weights::Robust },
    }));
    let velocity = option(spec.velocity.map(|velocity| match velocity {
        VelocitySpec::Derived => quote! { settings::Velocity::Derived },
        VelocitySpec::Measured => quote! { settings::Velocity::Measured },
    }));
    let freedom = option(spec.degrees_of_freedom.map(|freedom| match freedom {
        FreedomSpec::Parameters => quote! { settings::Freedom::Parameters },
        FreedomSpec::Mean => quote! { settings::Freedom::Mean },
    }));
    let prefilter_torque = option(spec.prefilter_torque.map(|yes| quote! { #yes }));
    let gains = robot.description.drives.gains.iter().copied().map(signed);
    let coupling = robot
        .description
        .drives
        .coupling
        .iter()
        .copied()
        .map(signed);
    quote! {
        settings::Settings {
            fq_hz: #fq_hz,
            order: #order,
            nd: #nd,
            trim: #trim,
            border: #border,
            edges: #edges,
            weights: #weights,
            velocity: #velocity,
            prefilter_torque: #prefilter_torque,
            degrees_of_freedom: #freedom,
            drives: settings::Drives {
                gains: Cow::Borrowed(&[#(#gains),*]),
                coupling: Cow::Borrowed(&[#(#coupling),*]),
            },
        }
    }
}

/// `Knowledge { .. }`.
pub fn knowledge(robot: &Robot) -> TokenStream {
    let known = Knowledge::of(robot);
    let nominal = known.nominal.iter().map(|value| option(value.map(signed)));
    let rigid = known.rigid.iter().copied().map(signed);
    let prior = known.prior.iter().flatten().copied().map(signed);
    let terms = known.terms.iter().map(|term| {
        let [column, link, parameter] =
            [term.column, term.link, term.parameter].map(Literal::usize_unsuffixed);
        let factor = signed(term.factor);
        quote! { term(#column, #link, #parameter, #factor) }
    });
    quote! {
        Knowledge {
            nominal: Cow::Borrowed(&[#(#nominal),*]),
            rigid: Cow::Borrowed(&[#(#rigid),*]),
            terms: Cow::Borrowed(&[#(#terms),*]),
            prior: Cow::Borrowed(&[#(#prior),*]),
        }
    }
}

/// A literal with its sign as an operator of its own: a negative literal panics.
fn signed(value: f64) -> TokenStream {
    let size = Literal::f64_unsuffixed(value.abs());
    if value < 0.0 {
        quote! { -#size }
    } else {
        quote! { #size }
    }
}

fn option(value: Option<impl quote::ToTokens>) -> TokenStream {
    match value {
        Some(value) => quote! { Some(#value) },
        None => quote! { None },
    }
}
