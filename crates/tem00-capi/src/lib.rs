//! C interface of tem00.
