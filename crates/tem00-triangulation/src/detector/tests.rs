//! Detectors against closed forms.
