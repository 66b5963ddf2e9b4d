// SPDX-License-Identifier: MIT
#include "cad_import/losses.hpp"

#include <Bnd_Box.hxx>
#include <Interface_Check.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <Interface_InterfaceModel.hxx>
#include <STEPCAFControl_ExternFile.hxx>
#include <StepBasic_NamedUnit.hxx>
#include <StepGeom_CartesianPoint.hxx>
#include <StepGeom_CartesianTransformationOperator3d.hxx>
#include <StepGeom_Curve.hxx>
#include <StepGeom_Direction.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepGeom_Placement.hxx>
#include <StepGeom_Point.hxx>
#include <StepGeom_Surface.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepShape_Block.hxx>
#include <StepShape_CsgSolid.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_RightCircularCone.hxx>
#include <StepShape_RightCircularCylinder.hxx>
#include <StepShape_Sphere.hxx>
#include <StepShape_SweptAreaSolid.hxx>
#include <StepShape_SweptFaceSolid.hxx>
#include <StepShape_TopologicalRepresentationItem.hxx>
#include <StepShape_Torus.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TransferBRep.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <cmath>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>
#include <unordered_set>

#include "kernels/part/names.hpp"

namespace hapticd::cad {
namespace {

using Entity = Handle(Standard_Transient);

/// Returns the extent [mm] of the points from which a face of a STEP file is made; 0 if none are found.
double extentOf(const Interface_Graph& graph, const Entity& face, double to_mm) {
  constexpr std::size_t kMostEntities = 20'000;
  Bnd_Box box;
  std::vector<Entity> open{face};
  std::unordered_set<const Standard_Transient*> met;
  while (!open.empty() && met.size() < kMostEntities) {
    const Entity entity = open.back();
    open.pop_back();
    if (!met.insert(entity.get()).second) continue;
    if (const auto point = Handle(StepGeom_CartesianPoint)::DownCast(entity); !point.IsNull()) {
      if (point->NbCoordinates() == 3 &&
          std::isfinite(point->CoordinatesValue(1) + point->CoordinatesValue(2) + point->CoordinatesValue(3)))
        box.Add(gp_Pnt(point->CoordinatesValue(1), point->CoordinatesValue(2), point->CoordinatesValue(3)));
      continue;
    }
    for (Interface_EntityIterator next = graph.Shareds(entity); next.More(); next.Next()) open.push_back(next.Value());
  }
  const double extent = box.IsVoid() ? 0 : to_mm * std::sqrt(box.SquareExtent());
  return extent < 1e9 ? extent : 1e9;
}

std::string reasonOf(const Handle(Transfer_Binder) & binder) {
  if (binder.IsNull()) return "it belongs to no solid, shell or set of surfaces that could be read";
  const Handle(Interface_Check) check = binder->Check();
  if (check->NbFails() > 0) return check->CFail(1);
  if (check->NbWarnings() > 0) return check->CWarning(1);
  return "the reader could not convert it";
}

std::string nameOf(const std::string& word, const Handle(Interface_InterfaceModel) & model, const Entity& entity) {
  const Handle(TCollection_HAsciiString) label = model->StringLabel(entity);
  std::string text = word + " " + std::string(label.IsNull() ? "" : label->ToCString());
  const auto item = Handle(StepRepr_RepresentationItem)::DownCast(entity);
  if (!item.IsNull() && !item->Name().IsNull() && item->Name()->Length() > 0)
    text += " '" + std::string(item->Name()->ToCString()) + "'";
  return text;
}

/// Returns true for entities that carry geometry or topology (points, curves, surfaces, edges, faces), and false for
/// others such as texts and colours.
bool isForm(const Entity& entity) {
  return entity->IsKind(STANDARD_TYPE(StepGeom_Point)) || entity->IsKind(STANDARD_TYPE(StepGeom_Direction)) ||
         entity->IsKind(STANDARD_TYPE(StepGeom_Placement)) || entity->IsKind(STANDARD_TYPE(StepGeom_Curve)) ||
         entity->IsKind(STANDARD_TYPE(StepGeom_Surface)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_TopologicalRepresentationItem));
}

/// Returns true for solids that are no boundary, and for the primitives of which they are made. None is read.
bool isMade(const Entity& entity) {
  return entity->IsKind(STANDARD_TYPE(StepShape_CsgSolid)) || entity->IsKind(STANDARD_TYPE(StepShape_SweptAreaSolid)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_SweptFaceSolid)) || entity->IsKind(STANDARD_TYPE(StepShape_Block)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_RightCircularCylinder)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_RightCircularCone)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_Sphere)) || entity->IsKind(STANDARD_TYPE(StepShape_Torus));
}

gp_Vec directionOr(const Handle(StepGeom_Direction) & axis, const gp_Vec& otherwise) {
  if (axis.IsNull() || axis->NbDirectionRatios() != 3) return otherwise;
  return {axis->DirectionRatiosValue(1), axis->DirectionRatiosValue(2), axis->DirectionRatiosValue(3)};
}

/// Returns true if the three axes of a copy are left-handed (base_axis of ISO 10303-42).
bool isMirror(const StepGeom_CartesianTransformationOperator3d& copy) {
  const gp_Vec x = directionOr(copy.Axis1(), {1, 0, 0}), y = directionOr(copy.Axis2(), {0, 1, 0}),
               z = directionOr(copy.Axis3(), {0, 0, 1});
  return x.Crossed(y).Dot(z) < 0;
}

bool assignsUnits(const Entity& entity) {
  return entity->IsKind(STANDARD_TYPE(StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext)) ||
         entity->IsKind(STANDARD_TYPE(StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx)) ||
         entity->IsKind(STANDARD_TYPE(StepRepr_GlobalUnitAssignedContext));
}

}  // namespace

void findMadeSolids(const Handle(XSControl_WorkSession) & session, std::vector<brep::Loss>& losses) {
  const Handle(Interface_InterfaceModel) model = session->Model();
  if (model.IsNull()) return;
  for (Standard_Integer i = 1; i <= model->NbEntities(); ++i)
    if (isMade(model->Value(i)))
      losses.push_back({nameOf("solid", model, model->Value(i)),
                        "it is made of primitives, sweeps or Boolean operations; export its boundary (a B-rep)", 0,
                        brep::kNone});
}

void findChangedCopies(const Handle(XSControl_WorkSession) & session, std::vector<brep::Loss>& losses) {
  const Handle(Interface_InterfaceModel) model = session->Model();
  if (model.IsNull()) return;
  for (Standard_Integer i = 1; i <= model->NbEntities(); ++i) {
    const auto copy = Handle(StepGeom_CartesianTransformationOperator3d)::DownCast(model->Value(i));
    if (copy.IsNull()) continue;
    const double scale = copy->HasScale() ? copy->Scale() : 1;
    const bool scaled = std::abs(scale - 1) > 1e-9;
    if (!scaled && !isMirror(*copy)) continue;
    losses.push_back({nameOf("copy", model, copy),
                      !scaled ? "it was to be mirrored, and was only turned: the part has another shape there"
                              : "it was to be scaled, and was only moved: the part has another size there",
                      0, brep::kNone});
  }
}

void findMissingEntities(const Handle(XSControl_WorkSession) & session, std::vector<brep::Loss>& losses) {
  constexpr std::size_t kMost = 100;
  if (session->Model().IsNull()) return;
  const Handle(Interface_Check) check = session->Model()->GlobalCheck(Standard_True);
  for (Standard_Integer i = 1; i <= check->NbFails() && losses.size() < kMost; ++i) {
    const std::string text = check->CFail(i);  // for example "Unresolved Reference, Ent.Id.#16 Param.n0 4 (Id.#284)".
    if (text.rfind("Unresolved", 0) != 0) continue;
    const std::size_t from = text.rfind('#'), to = text.find(')', from);
    const std::string what = from < to && to != std::string::npos ? "entity " + text.substr(from, to - from) : text;
    losses.push_back({what, "other entities refer to it, but the file does not contain it", 0, brep::kNone});
  }
}

void findMissingFiles(const STEPCAFControl_Reader& reader, std::vector<brep::Loss>& losses) {
  for (NCollection_DataMap<TCollection_AsciiString, Handle(STEPCAFControl_ExternFile)>::Iterator at(
           reader.ExternFiles());
       at.More(); at.Next()) {
    const Handle(STEPCAFControl_ExternFile) & file = at.Value();
    if (!file.IsNull() && file->GetLoadStatus() == IFSelect_RetDone && file->GetTransferStatus()) continue;
    losses.push_back({"the part in the file '" + brep::plainText(at.Key().ToCString()) + "'",
                      "that file is not there or cannot be read; put it beside this one and import again", 0,
                      brep::kNone});
  }
}

void findOddEntities(const Handle(XSControl_WorkSession) & session, std::vector<std::string>& remarks) {
  constexpr std::size_t kMost = 10;
  const Handle(Interface_InterfaceModel) model = session->Model();
  if (model.IsNull()) return;
  bool assigned = false;
  std::size_t odd_shapes = 0;
  std::string first_shape;
  for (Standard_Integer i = 1; i <= model->NbEntities(); ++i) {
    const Entity entity = model->Value(i);
    assigned = assigned || assignsUnits(entity);
    const bool unit = entity->IsKind(STANDARD_TYPE(StepBasic_NamedUnit));
    if (!unit && !isForm(entity)) continue;
    const Handle(Interface_Check) check = model->Check(i, Standard_True);
    if (check.IsNull() || check->NbFails() == 0) continue;
    const Handle(TCollection_HAsciiString) label = model->StringLabel(entity);
    const std::string what = std::string(label.IsNull() ? "" : label->ToCString()) + " cannot be read (" +
                             brep::plainText(check->CFail(1)) + ")";
    if (!unit && odd_shapes++ == 0) first_shape = what;
    if (unit && remarks.size() < kMost)
      remarks.push_back("unit " + what + ", so a unit was assumed; check the size of the part");
  }
  if (odd_shapes > 0)
    remarks.push_back("entity " + first_shape +
                      (odd_shapes > 1 ? ", and neither can " + std::to_string(odd_shapes - 1) + " others" : "") +
                      ": the file is damaged, and the part may have another shape; compare it with the CAD program");
  if (!assigned) remarks.emplace_back(kNoUnit);
}

void findLostFaces(const Handle(XSControl_WorkSession) & session, double to_mm, std::vector<brep::Loss>& losses) {
  const Handle(Interface_InterfaceModel) model = session->Model();
  const Handle(Transfer_TransientProcess) made = session->TransferReader()->TransientProcess();
  if (model.IsNull() || made.IsNull()) return;
  std::vector<Entity> lost;
  for (Standard_Integer i = 1; i <= model->NbEntities(); ++i) {
    const Entity entity = model->Value(i);
    if (!entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface))) continue;
    const Handle(Transfer_Binder) binder = made->Find(entity);
    if (binder.IsNull() || TransferBRep::ShapeResult(binder).IsNull()) lost.push_back(entity);
  }
  if (lost.empty()) return;
  const Interface_Graph graph(model);
  for (const Entity& entity : lost)
    losses.push_back({nameOf("face", model, entity), reasonOf(made->Find(entity)),
                      1e-3 * extentOf(graph, entity, to_mm), brep::kNone});
}

}  // namespace hapticd::cad
