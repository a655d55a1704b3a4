//! What the registers of lanes have in common.

/// The operators of a register of lanes, one intrinsic each, which the machine has wherever the type is used.
macro_rules! arithmetic {
    ($lanes:ident: $($operator:ident $method:ident $intrinsic:ident;)*) => {$(
        impl std::ops::$operator for $lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the machine has the register.
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    )*};
}
pub(super) use arithmetic;
