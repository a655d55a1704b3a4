//! Whether the advice of the paper holds here.
