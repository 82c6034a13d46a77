"""Smoothers of other projects on the same meshes (optional extra ``peers``).

Each takes points (n, 2) and counter-clockwise triangles (m, 3) and returns new points in the same
order, with the connectivity as it is; what it does to the boundary is its own affair, so boundary
points are put back where that is the only way.  None of them promises to invert nothing.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np

from harness.mesh.stars import Ints
from harness.mesh.validation import Floats, boundary

Smoother = Callable[[Floats, Ints], Floats]
STEPS = 50
"""Sweeps, where a smoother asks how many."""


def _netgen(steps: int) -> Smoother:
    """OptimizeMesh2d('m'): it moves nothing until the mesh has a geometry."""

    def smooth(points: Floats, triangles: Ints) -> Floats:
        from netgen.geom2d import SplineGeometry
        from netgen.meshing import Element1D, Element2D, FaceDescriptor, Mesh, MeshPoint, Pnt

        geometry = SplineGeometry()
        low, high = points.min(axis=0), points.max(axis=0)
        geometry.AddRectangle(tuple(low), tuple(high))
        mesh = Mesh(dim=2)
        mesh.SetGeometry(geometry)
        names = [mesh.Add(MeshPoint(Pnt(float(x), float(y), 0.0))) for x, y in points]
        mesh.Add(FaceDescriptor(surfnr=1, domin=1, domout=0, bc=1))
        for triangle in triangles.tolist():
            mesh.Add(Element2D(1, [names[v] for v in triangle]))
        for a, b in boundary(triangles)[0].tolist():
            mesh.Add(Element1D([names[a], names[b]], index=1))
        mesh.OptimizeMesh2d(_netgen_parameters(steps))
        return np.array([mesh[name].p[:2] for name in names])

    return smooth


def _netgen_parameters(steps: int) -> Any:
    from netgen.meshing import MeshingParameters

    return MeshingParameters(optimize2d="m", optsteps2d=steps, elsizeweight=0.0)


def _gmsh(method: str) -> Smoother:
    """gmsh.model.mesh.optimize: it wants parametric coordinates and may number nodes anew."""

    def smooth(points: Floats, triangles: Ints) -> Floats:
        import gmsh

        gmsh.initialize(interruptible=False)
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            return _smoothed_by_gmsh(gmsh, method, points, triangles)
        finally:
            gmsh.finalize()

    return smooth


def _smoothed_by_gmsh(gmsh: Any, method: str, points: Floats, triangles: Ints) -> Floats:
    """The mesh as that of a true rectangle, whose sides hold the boundary nodes."""
    low, high = points.min(axis=0), points.max(axis=0)
    rim = np.unique(boundary(triangles)[0])
    inner = np.setdiff1d(np.arange(len(points)), rim)
    space = np.column_stack([points, np.zeros(len(points))])
    model, nodes = gmsh.model, gmsh.model.mesh
    model.occ.addRectangle(*low, 0, *(high - low))
    model.occ.synchronize()
    corners = set()
    for _, tag in model.getEntities(0):
        at = model.getValue(0, tag, [])[:2]
        corners.add(near := int(np.argmin(((points - at) ** 2).sum(axis=1))))
        nodes.addNodes(0, tag, [near + 1], space[near])
    for _, tag in model.getEntities(1):
        box = np.array(model.getBoundingBox(1, tag)).reshape(2, 3)[:, :2]
        axis = int(np.argmin(np.ptp(box, axis=0)))
        on = rim[np.abs(points[rim, axis] - box[:, axis].mean()) < 1e-6]
        on = np.array([v for v in on.tolist() if v not in corners], dtype=np.int64)
        if len(on):
            place = model.getParametrization(1, tag, space[on].ravel())
            nodes.addNodes(1, tag, on + 1, space[on].ravel(), place)
    place = model.getParametrization(2, 1, space[inner].ravel())
    nodes.addNodes(2, 1, inner + 1, space[inner].ravel(), place)
    nodes.addElementsByType(1, 2, [], (triangles + 1).ravel())
    before = nodes.getElements(2, 1)[2][0].astype(np.int64)
    nodes.optimize(method, niter=STEPS)
    after = nodes.getElements(2, 1)[2][0].astype(np.int64)
    tags, places, _ = nodes.getNodes()
    where = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    where[tags.astype(np.int64)] = np.arange(len(tags))
    moved = points.copy()
    moved[before - 1] = places.reshape(-1, 3)[where[after], :2]  # elements keep their order
    return moved


def _trimesh(points: Floats, triangles: Ints) -> Floats:
    """trimesh.smoothing.filter_laplacian with the boundary pinned."""
    import trimesh

    space = np.column_stack([points, np.zeros(len(points))])
    mesh = trimesh.Trimesh(space, triangles, process=False)
    pinned = np.unique(boundary(triangles)[0])
    weights = trimesh.smoothing.laplacian_calculation(mesh, pinned_vertices=pinned)
    trimesh.smoothing.filter_laplacian(
        mesh, lamb=0.5, iterations=STEPS, volume_constraint=False, laplacian_operator=weights
    )
    return np.array(mesh.vertices[:, :2])


def _skfem(points: Floats, triangles: Ints) -> Floats:
    """skfem.MeshTri.smoothed: Laplacian, the boundary stays."""
    from skfem import MeshTri

    mesh = MeshTri(np.ascontiguousarray(points.T), np.ascontiguousarray(triangles.T))
    for _ in range(STEPS):
        mesh = mesh.smoothed()
    return np.array(mesh.p.T)


def _igl(points: Floats, triangles: Ints) -> Floats:
    """libigl: the harmonic map with the boundary where it is (cotangent weights of the input)."""
    import igl

    rim = np.unique(boundary(triangles)[0])
    space = np.column_stack([points, np.zeros(len(points))])
    return np.array(igl.harmonic(space, triangles, rim, points[rim], 1))[:, :2]


def _pymeshlab(points: Floats, triangles: Ints) -> Floats:
    """MeshLab's Laplacian smoothing; boundary points are put back."""
    import pymeshlab

    space = np.column_stack([points, np.zeros(len(points))])
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(space, triangles))
    meshes.apply_coord_laplacian_smoothing(stepsmoothnum=STEPS, boundary=False)
    moved = np.array(meshes.current_mesh().vertex_matrix()[:, :2])
    rim = np.unique(boundary(triangles)[0])
    moved[rim] = points[rim]
    return moved


def _pyvista(points: Floats, triangles: Ints) -> Floats:
    """VTK's Laplacian smoothing by way of pyvista, the boundary fixed."""
    import pyvista

    space = np.column_stack([points, np.zeros(len(points))])
    faces = np.column_stack([np.full(len(triangles), 3), triangles])
    mesh = pyvista.PolyData(space, faces)
    done = mesh.smooth(n_iter=STEPS, relaxation_factor=0.5, boundary_smoothing=False)
    return np.array(done.points[:, :2], dtype=np.float64)


def _mmg(points: Floats, triangles: Ints) -> Floats:
    """mmg2d without insertion and swaps, and with the boundary as it is."""
    import mmgpy

    mesh = mmgpy.MmgMesh2D(points.copy(), triangles.astype(np.int32))
    mesh.remesh(noinsert=True, noswap=True, nosurf=True, nofem=True, verbose=-1)
    return np.array(mesh.get_vertices())  # in their order, as nothing else changes


_KNOWN: dict[str, tuple[str, Smoother]] = {
    "netgen-10": ("netgen", _netgen(10)),
    "netgen-30": ("netgen", _netgen(30)),
    "gmsh-laplace": ("gmsh", _gmsh("Laplace2D")),
    "gmsh-relocate": ("gmsh", _gmsh("Relocate2D")),
    "pyvista": ("pyvista", _pyvista),
    "trimesh": ("trimesh", _trimesh),
    "pymeshlab": ("pymeshlab", _pymeshlab),
    "scikit-fem": ("skfem", _skfem),
    "libigl": ("igl", _igl),
    "mmg2d": ("mmgpy", _mmg),
}

SMOOTHERS: dict[str, Smoother] = {
    name: smooth
    for name, (module, smooth) in _KNOWN.items()
    if importlib.util.find_spec(module) is not None
}
"""Those that are installed, by name."""
