//! idim
