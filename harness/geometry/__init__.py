"""Points, segments and what can be decided about them exactly; knows no diagram.

* :mod:`~harness.geometry.instance`, :mod:`~harness.geometry.formats`: an input, read and written.
* :mod:`~harness.geometry.validation`: whether it is proper, by an exact plane sweep.
* :mod:`~harness.geometry.visual_angle`, :mod:`~harness.geometry.predicates`: θ, its forms Q and L
  in floating point, and their exact comparison.
* :mod:`~harness.geometry.bisector`: the circular cubics on which two visual angles agree.
* :mod:`~harness.geometry.kernel`: the kernel of a polygon, exactly.

Everything that decides something first tries doubles with a proven error bound and falls back to
rational arithmetic, so decisions are never approximate.
"""
