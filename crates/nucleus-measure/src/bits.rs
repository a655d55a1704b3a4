//! Floating-point numbers as sixteen hexadecimal digits of their bits: for results that pass between processes as JSON,
//! which has no infinity and no NaN. Used as `#[serde(with = "crate::bits")]`.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Writes the bits of a number.
///
/// # Errors
/// Those of the serializer.
pub fn serialize<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    format!("{:016x}", number.to_bits()).serialize(serializer)
}

/// Reads a number from its bits.
///
/// # Errors
/// When the text is not a number in hexadecimal digits.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    let text = String::deserialize(deserializer)?;
    u64::from_str_radix(&text, 16).map(f64::from_bits).map_err(D::Error::custom)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    #[derive(Debug, serde::Serialize, serde::Deserialize)]
    struct Number(#[serde(with = "super")] f64);

    proptest! {
        #[test]
        fn every_number_keeps_its_bits(bits: u64) {
            let text = serde_json::to_string(&Number(f64::from_bits(bits))).unwrap();
            let Number(back) = serde_json::from_str(&text).unwrap();
            prop_assert_eq!(back.to_bits(), bits);
        }
    }

    #[test]
    fn other_text_is_refused() {
        for text in ["\"x\"", "\"\"", "1.5", "\"fffffffffffffffff\""] {
            assert!(serde_json::from_str::<Number>(text).is_err(), "{text}");
        }
    }
}
