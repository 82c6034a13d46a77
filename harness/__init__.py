"""Exact angular Voronoi diagrams and the experimental study of their complexity."""
