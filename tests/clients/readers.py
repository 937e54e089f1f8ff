"""Compares the fields of two .vtu files that ccx2paraview made: `readers.py OURS CCX`, rows of a table."""

import sys

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def fields(name):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    data = reader.GetOutput().GetPointData()
    arrays = (data.GetArray(i) for i in range(data.GetNumberOfArrays()))
    return {array.GetName(): vtk_to_numpy(array) for array in arrays}


ours, theirs = map(fields, sys.argv[1:3])
for name in sorted(set(ours) | set(theirs)):
    if name not in ours or name not in theirs:
        print(f"| ccx2paraview, `{name}` | in one of the two files only | |")
        continue
    most = numpy.abs(theirs[name]).max()
    if most == 0.0:
        continue
    off = numpy.abs(ours[name] - theirs[name]).max() / most
    print(f"| ccx2paraview, `{name}` | largest {most:.4g} | {off:.1e} |")
