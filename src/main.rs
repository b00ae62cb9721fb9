//! idim
fn main() {}
