//! Tests over the whole pipeline live in `tests/tests/`.
