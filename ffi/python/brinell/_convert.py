"""Results for other libraries, which are imported when they are asked for."""

import numpy as np

from ._errors import InputError

# Nodes stand in the order of VTK, which meshio takes.
_CELLS = {
    "tri3": "triangle",
    "tri6": "triangle6",
    "quad4": "quad",
    "quad8": "quad8",
    "tet4": "tetra",
    "tet10": "tetra10",
    "prism6": "wedge",
    "prism15": "wedge15",
    "hex8": "hexahedron",
    "hex20": "hexahedron20",
}
_OF_NODES = ["displacement", "nodal_stress", "contact_pressure", "gap"]
_OF_ELEMENTS = ["stress", "von_mises", "equivalent_plastic_strain", "yielded", "discretisation_error"]


def to_meshio(result, state=None):
    """The mesh, with the fields of a state (number or name; the last that has fields if not given)."""
    import meshio

    mesh = result.mesh
    if state is None:
        with_fields = [s for s in result if s.fields is not None]
        fields = with_fields[-1].fields if with_fields else {}
    else:
        fields = result[state].fields
        if fields is None:
            raise InputError(f"the state {state!r} has no fields", "input", 2)
    points = np.array(mesh["coordinates"])
    # Displacements and points have three components, so that every reader takes them.
    points = _in_space(points)
    shapes = np.array(mesh["shapes"])
    offsets, connectivity = mesh["offsets"], mesh["connectivity"]
    cells, order = [], []
    for shape in dict.fromkeys(mesh["shapes"]):
        elements = np.flatnonzero(shapes == shape)
        cells.append((_CELLS[shape], np.array([connectivity[offsets[e] : offsets[e + 1]] for e in elements])))
        order.append(elements)
    of_nodes = {name: np.array(fields[name]) for name in _OF_NODES if name in fields}
    if "displacement" in of_nodes:
        of_nodes["displacement"] = _in_space(of_nodes["displacement"])
    of_elements = {name: np.array(fields[name]) for name in _OF_ELEMENTS if name in fields}
    of_elements["body"] = np.array(mesh["element_body"])
    data = {name: [values[elements] for elements in order] for name, values in of_elements.items()}
    return meshio.Mesh(points, cells, point_data=of_nodes, cell_data=data)


def _in_space(rows):
    return np.hstack([rows, np.zeros((len(rows), 3 - rows.shape[1]))])


def plot(result, y="max_pressure", x="load", ax=None):
    """A column of the history against another, with names and units; the axes of matplotlib."""
    history = result.history
    for key in (x, y):
        if key not in history or key == "event":
            known = ", ".join(name for name in history if name != "event")
            raise InputError(f"the history has no {key!r}; its columns are {known}", "input", 2)
    if ax is None:
        import matplotlib.pyplot

        ax = matplotlib.pyplot.figure().subplots()
    ax.plot(history[x], history[y], marker=".")
    ax.set_xlabel(result.label(x))
    ax.set_ylabel(result.label(y))
    return ax
