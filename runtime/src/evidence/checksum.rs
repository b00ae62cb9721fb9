//! A checksum that finds cut, swapped and flipped bytes; no protection against intent.

/// CRC-64/XZ (ECMA-182, reflected), the checksum of xz files.
pub(super) struct Checksum(u64);

/// The polynomial of ECMA-182, reflected.
const POLYNOMIAL: u64 = 0xC96C_5795_D787_0F42;

/// What a byte does to the register.
const TABLE: [u64; 256] = table();

const fn table() -> [u64; 256] {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut register = byte as u64;
        let mut bit = 0;
        while bit < 8 {
            let carry = register & 1 == 1;
            register = (register >> 1) ^ if carry { POLYNOMIAL } else { 0 };
            bit += 1;
        }
        table[byte] = register;
        byte += 1;
    }
    table
}

impl Default for Checksum {
    fn default() -> Self {
        Checksum(!0)
    }
}

impl Checksum {
    /// Goes on with `bytes`.
    pub fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            let place = (self.0 as u8 ^ byte) as usize;
            self.0 = TABLE[place] ^ (self.0 >> 8);
        }
    }

    /// The checksum of all bytes so far.
    pub fn value(&self) -> u64 {
        !self.0
    }

    /// The checksum of `bytes`.
    pub fn of(bytes: &[u8]) -> u64 {
        let mut sum = Checksum::default();
        sum.add(bytes);
        sum.value()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn check_string_gives_the_catalogued_value() {
        assert_eq!(Checksum::of(b"123456789"), 0x995D_C9BB_DF19_39FA);
    }
}
