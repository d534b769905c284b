"""Exponential means, computed: of lists of outcomes, by closed forms, and by quadrature."""
