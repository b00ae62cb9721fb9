//! Generates the built-in robots: whatever lies in `robots/`.

fn main() -> Result<(), String> {
    let robots = idim_codegen::Builder::new().robots_in("robots");
    robots.generate().map_err(|error| error.to_string())
}
