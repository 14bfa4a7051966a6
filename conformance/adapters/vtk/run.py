import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "readers"))
import vtk
from case import run


def compute(case):
    if set(case["faces"]) - {3}:
        raise ValueError("skip: triangles only")
    if case["threshold"] != 180.0:
        raise ValueError("skip: no angular threshold")
    points, normals, uvs, cells = vtk.vtkPoints(), vtk.vtkFloatArray(), vtk.vtkFloatArray(), vtk.vtkCellArray()
    normals.SetNumberOfComponents(3)
    uvs.SetNumberOfComponents(2)
    for position, normal, uv in zip(case["positions"], case["normals"], case["uvs"]):
        points.InsertNextPoint(position)
        normals.InsertNextTuple3(*normal)
        uvs.InsertNextTuple2(*uv)
    for at in range(0, len(case["indices"]), 3):
        cells.InsertNextCell(3, case["indices"][at : at + 3])
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    data.GetPointData().SetNormals(normals)
    data.GetPointData().SetTCoords(uvs)
    tool = vtk.vtkPolyDataTangents()
    tool.SetInputData(data)
    start = time.process_time()
    tool.Update()
    seconds = time.process_time() - start
    found = tool.GetOutput().GetPointData().GetTangents()
    # VTK has no sign: its shader takes cross(normal, tangent).
    tangents = [(*found.GetTuple3(vertex), 1.0) if found else (0.0,) * 4 for vertex in range(len(case["positions"]))]
    return {"tangents": tangents, "indices": case["indices"], "seconds": seconds}


run(compute)
