#![no_main]

use idim_codegen::describe::Kind;

libfuzzer_sys::fuzz_target!(|text: &[u8]| idim_fuzz::follow(text, Kind::Toml));
