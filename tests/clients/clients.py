"""FreeCAD writes decks, ccx and brinell in its place run them, FreeCAD reads the results.

Run by FreeCAD itself (`make test-clients`):

    BRINELL_CCX=/path/brinell-ccx CLIENTS_OUT=/tmp/out freecadcmd tests/clients/clients.py

Prints one line of a Markdown table for each example: what the result object of FreeCAD holds with
either program (largest displacement and von Mises stress), the largest difference as a share of the
largest value, and the seconds of both.
"""

import glob
import importlib
import os
import shutil
import subprocess
import sys
import time

import FreeCAD
import ObjectsFem
import Part
import femtest
from feminout import importCcxFrdResults
from femmesh import gmshtools
from femtools import ccxtools

# Example of FreeCAD, what it shows, and what explains a difference.
EXAMPLES = [
    ("ccx_cantilever_faceload", "face load"),
    ("ccx_cantilever_nodeload", "forces on nodes"),
    ("ccx_cantilever_prescribeddisplacement", "displacement"),
    ("ccx_cantilever_ele_tetra4", "linear tetrahedra"),
    ("ccx_cantilever_ele_hexa20", "C3D20"),
    ("boxanalysis_static", "pressure, forces"),
    ("constraint_contact_solid_solid", "contact", "ccx's contact is a spring, here it is hard "
     "up to the slope of the deck; nodes at the edge are held"),
    ("press_fit", "press fit", "ccx's contact is a spring"),
    ("constraint_tie", "tie", "three nodes in a line are fixed, about which it turns freely: "
     "the displacements are arbitrary, compare the stresses; the tie holds in the mean"),
    ("constraint_section_print", "section print"),
    ("constraint_selfweight_cantilever", "own weight"),
    ("constraint_centrif", "rotation", "nothing holds the disc along x: ccx moves it by kilometres"),
    ("constraint_transform_beam_hinged", "transform", "nothing holds the beam along its hinges: "
     "the displacements are arbitrary, compare the stresses"),
    ("constraint_transform_torque", "transform"),
    ("rc_wall_2d", "shells"),
    ("material_nl_platewithhole", "plasticity", "NLGEOM in ccx, small displacements here: it flows "
     "beyond the end of its curve, where the change of sections counts most (a warning says so)"),
    ("material_multiple_bendingbeam_fiveboxes", "several materials"),
    ("material_multiple_tensionrod_twoboxes", "several materials"),
    ("thermomech_bimetall", "heat flow"),
    ("thermomech_flow1d", "heat flow"),
    ("thermomech_spine", "heat flow"),
    ("constraint_contact_shell_shell", "shells"),
]


def press_fit(doc, kind):
    """A quarter of a sleeve on a shaft that is 0.02 thicker than its bore, drawn as they overlap."""
    def quarter(inner, outer, height):
        zero, up = FreeCAD.Vector(0, 0, 0), FreeCAD.Vector(0, 0, 1)
        bored = Part.makeCylinder(inner, height, zero, up, 90)
        return Part.makeCylinder(outer, height, zero, up, 90).cut(bored)

    shaft, sleeve = quarter(2.0, 5.01, 4.0), quarter(5.0, 10.0, 4.0)
    parts = doc.addObject("Part::Feature", "Parts")
    parts.Shape = Part.makeCompound([shaft, sleeve])
    analysis = ObjectsFem.makeAnalysis(doc, "Analysis")
    solver = ObjectsFem.makeSolverCalculixCcxTools(doc, "CalculiXccxTools")
    solver.AnalysisType, solver.GeometricalNonlinearity = "static", "linear"
    solver.ThermoMechSteadyState, solver.IterationsControlParameterTimeUse = False, False
    analysis.addObject(solver)
    steel = ObjectsFem.makeMaterialSolid(doc, "Steel")
    material = steel.Material
    material.update(Name="Steel", YoungsModulus="200000 MPa", PoissonRatio="0.30")
    steel.Material = material
    analysis.addObject(steel)

    faces = {"x": [], "y": [], "z": []}
    contact = {}
    for number, face in enumerate(parts.Shape.Faces, 1):
        name, box = "Face%d" % number, face.BoundBox
        for axis in "xyz":
            low, high = getattr(box, axis.upper() + "Min"), getattr(box, axis.upper() + "Max")
            if abs(high) + abs(low) < 1e-6:
                faces[axis].append((parts, name))
        radius = getattr(face.Surface, "Radius", 0.0)
        if abs(radius - 5.005) < 0.006:
            contact[radius] = (parts, name)
    for axis, held in faces.items():
        support = ObjectsFem.makeConstraintDisplacement(doc, "Plane" + axis)
        support.References = held
        setattr(support, axis + "Free", False)
        setattr(support, axis + "Fix", True)
        analysis.addObject(support)
    pair = ObjectsFem.makeConstraintContact(doc, "Fit")
    pair.References = [contact[5.0], contact[max(contact)]]
    pair.Friction, pair.Slope = 0.0, 1e7
    analysis.addObject(pair)
    mesh = analysis.addObject(ObjectsFem.makeMeshGmsh(doc, "Mesh"))[0]
    mesh.Part, mesh.CharacteristicLengthMax, mesh.SecondOrderLinear = parts, 1.0, False
    doc.recompute()
    gmshtools.GmshTools(mesh).create_mesh()
    doc.recompute()


OWN = {"press_fit": press_fit}


def solver_of(doc):
    for member in doc.Analysis.Group:
        if member.isDerivedFrom("Fem::FemSolverObjectPython"):
            return member
    raise RuntimeError("no solver")


def solve(doc, program, folder):
    """Writes the deck, runs it, loads the results; displacements, stresses, seconds, what is wrong."""
    os.makedirs(folder, exist_ok=True)
    fea = ccxtools.FemToolsCcx(doc.Analysis, solver_of(doc), test_mode=False)
    fea.purge_results()
    fea.update_objects()
    fea.setup_working_dir(folder)
    # The path in FreeCAD's settings, as a user gives it.
    settings = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/Fem/Ccx")
    settings.SetBool("UseStandardCcxLocation", False)
    settings.SetString("ccxBinaryPath", program)
    fea.setup_ccx(program)
    message = fea.check_prerequisites()
    if message:
        return None, None, 0.0, message
    fea.write_inp_file()
    start = time.time()
    code = fea.ccx_run()
    seconds = time.time() - start
    if code:
        text = fea.ccx_stdout or ""
        lines = [line.strip() for line in text.splitlines() if "*ERROR" in line]
        return None, None, seconds, "; ".join(lines)[:300] or "exit %s" % code
    # Who ran it says so.
    if ("brinell" in fea.ccx_stdout) != ("brinell" in os.path.basename(program)):
        return None, None, seconds, "another program ran"
    fea.load_results()
    found = [m for m in doc.Analysis.Group if m.isDerivedFrom("Fem::FemResultObject")]
    if not found:
        return None, None, seconds, "no result object"
    result = found[-1]
    moved = dict(zip(result.NodeNumbers, result.DisplacementVectors))
    mises = dict(zip(result.NodeNumbers, result.vonMises))
    return moved, mises, seconds, ""


def compared(name, what, own, other):
    moved, mises, seconds, wrong = own
    moved_ccx, mises_ccx, seconds_ccx, wrong_ccx = other
    if wrong_ccx:
        return "| %s | %s | | | | ccx: %s |" % (name, what, wrong_ccx)
    if wrong:
        return "| %s | %s | | | | %s |" % (name, what, wrong)
    if set(moved) != set(moved_ccx):
        return "| %s | %s | | | | other nodes |" % (name, what)
    largest = max(v.Length for v in moved_ccx.values()) or 1.0
    off = max((moved[n] - moved_ccx[n]).Length for n in moved) / largest
    most = max(mises_ccx.values()) or 1.0
    off_mises = max(abs(mises[n] - mises_ccx[n]) for n in mises) / most
    return "| %s | %s | %.4g, %.1e | %.4g, %.1e | %.1f, %.1f | |" % (
        name, what, largest, off, most, off_mises, seconds, seconds_ccx)


def read_back(deck, program, folder):
    """Runs a deck of FreeCAD's tests and reads the results by FreeCAD's importer, as `solve` does."""
    os.makedirs(folder, exist_ok=True)
    name = os.path.splitext(os.path.basename(deck))[0]
    shutil.copy(deck, folder)
    start = time.time()
    run = subprocess.run([program, "-i", name], cwd=folder, capture_output=True, text=True)
    seconds = time.time() - start
    if run.returncode:
        lines = [line.strip() for line in run.stdout.splitlines() if "*ERROR" in line]
        return None, None, seconds, "; ".join(lines)[:300] or "exit %s" % run.returncode
    doc = FreeCAD.newDocument("ReadBack")
    importCcxFrdResults.importFrd(os.path.join(folder, name + ".frd"))
    found = [o for o in doc.Objects if o.isDerivedFrom("Fem::FemResultObject")]
    if not found:
        FreeCAD.closeDocument(doc.Name)
        return None, None, seconds, "no result object"
    result = found[-1]
    moved = dict(zip(result.NodeNumbers, result.DisplacementVectors))
    mises = dict(zip(result.NodeNumbers, result.vonMises))
    FreeCAD.closeDocument(doc.Name)
    return moved, mises, seconds, ""


def decks_of_tests(program, ccx, out, chosen):
    """A line for each deck of FreeCAD's own tests."""
    folder = os.path.join(os.path.dirname(femtest.__file__), "data", "calculix")
    for deck in sorted(glob.glob(os.path.join(folder, "*.inp"))):
        name = os.path.basename(deck)
        if chosen and name not in chosen:
            continue
        try:
            other = read_back(deck, ccx, os.path.join(out, name, "ccx"))
            own = read_back(deck, program, os.path.join(out, name, "brinell"))
            line = compared(name, "", own, other)
        except Exception as error:
            line = "| %s | | | | | %s: %s |" % (name, type(error).__name__, error)
        with open(os.path.join(out, "decks.md"), "a") as table:
            table.write(" ".join(line.split()) + "\n")


def main():
    program = os.environ["BRINELL_CCX"]
    ccx = os.environ.get("CCX", "/usr/bin/ccx")
    out = os.environ["CLIENTS_OUT"]
    chosen = os.environ.get("CLIENTS_ONLY", "").split()
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    for name, what, *why in EXAMPLES:
        if chosen and name not in chosen:
            continue
        try:
            setup = OWN.get(name) or importlib.import_module("femexamples." + name).setup
            doc = FreeCAD.newDocument(name)
            setup(doc, "ccxtools")
            doc.recompute()
            other = solve(doc, ccx, os.path.join(out, name, "ccx"))
            own = solve(doc, program, os.path.join(out, name, "brinell"))
            line = compared(name, what, own, other)
            FreeCAD.closeDocument(doc.Name)
        except Exception as error:
            line = "| %s | %s | | | | %s: %s |" % (name, what, type(error).__name__, error)
        line = " ".join(line.split())
        if why:
            line = line[:-1].rstrip() + " " + why[0] + " |"
        with open(os.path.join(out, "freecad.md"), "a") as table:
            table.write(line + "\n")
    decks_of_tests(program, ccx, out, chosen)


main()
