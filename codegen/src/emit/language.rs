//! What differs between the languages inside an expression.

use crate::expr::{Function, Input};

/// How a language spells the leaves and the functions of an expression; sums, products and signs
/// are spelled alike in all of them.
pub trait Language {
    /// Words that no value may be called: keywords, arguments, functions.
    fn reserved(&self) -> Vec<String>;
    /// An input, such as `q[1]`.
    fn input(&self, input: Input) -> String;
    /// A sine or cosine by its name, such as `s23`.
    fn trig(&self, name: &str) -> String;
    /// The constants 0 and 1; all others have names.
    fn number(&self, value: f64) -> String;
    /// A function of an operand: `bare` as it is, `factor` in parentheses where a product or a
    /// method needs them.
    fn call(&self, function: Function, bare: &str, factor: &str) -> String;
    /// Whether a product is spelled as [`times`](Language::times) where the sum that it enters rounds
    /// it; other languages leave that to their compilers.
    fn fuses(&self) -> bool {
        false
    }
    /// A product that the sum it enters rounds: `first` has parentheses around a sum, `second` none.
    fn times(&self, first: &str, second: &str) -> String {
        format!("{first} * ({second})")
    }
    /// Whether a function computes the sines and cosines that it needs; otherwise the state has
    /// them.
    fn computes_trig(&self) -> bool;
}
