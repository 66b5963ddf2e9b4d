// SPDX-License-Identifier: MIT
#include "cad_import/iges_losses.hpp"

#include <IGESBasic_SingularSubfigure.hxx>
#include <IGESData_IGESEntity.hxx>
#include <Interface_Check.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <Interface_InterfaceModel.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TransferBRep.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <cstdio>
#include <string>

#include "kernels/part/names.hpp"

namespace hapticd::cad {
namespace {

using IgesEntity = Handle(IGESData_IGESEntity);

// Numbers of entities in IGES 5.3.
constexpr int kSubfigureDefinition = 308, kGroup = 402, kSubfigure = 408;

/// Returns what a person calls an entity that is felt, by its number; nullptr if it is none.
const char* wordFor(int type) {
  switch (type) {
    case 114:
    case 118:
    case 120:
    case 122:
    case 128:
    case 140:
    case 143:
    case 144:
      return "surface";
    case 150:
    case 152:
    case 154:
    case 156:
    case 158:
    case 160:
    case 162:
    case 164:
    case 168:
    case 180:
    case 184:
    case 186:
      return "solid";
    case kSubfigure:
      return "subfigure";
    case 412:
    case 414:
      return "array of subfigures";
    default:
      return nullptr;
  }
}

/// Returns true if an entity is a piece of the model, and not only the base of others, such as the surface under a
/// trimmed one. The entities of a definition stand in the model only through the subfigures that use it.
bool standsAlone(const Interface_Graph& graph, const IgesEntity& entity) {
  for (Interface_EntityIterator at = graph.Sharings(entity); at.More(); at.Next()) {
    const auto user = IgesEntity::DownCast(at.Value());
    const bool holds =
        !user.IsNull() && user->TypeNumber() == kSubfigureDefinition && entity->TypeNumber() >= kSubfigure;
    if (!user.IsNull() && user->TypeNumber() != kGroup && !holds) return false;
  }
  return true;
}

std::string reasonFor(const IgesEntity& entity, const Handle(Transfer_Binder) & binder) {
  const int type = entity->TypeNumber();
  if (const auto figure = Handle(IGESBasic_SingularSubfigure)::DownCast(entity);
      !figure.IsNull() && figure->ScaleFactor() != 1) {
    char text[80];
    std::snprintf(text, sizeof text, "its scale is %.6g, and only subfigures of scale 1 are read",
                  figure->ScaleFactor());
    return text;
  }
  if (type > kSubfigure) return "only single subfigures (IGES 408) are read; export each copy alone";
  if (type >= 150 && type < 186)
    return "it is made of primitives and Boolean operations; export its boundary (IGES 186) or trimmed surfaces (144)";
  const Handle(Interface_Check) check = binder.IsNull() ? Handle(Interface_Check)() : binder->Check();
  if (!check.IsNull() && check->NbFails() > 0) return brep::plainText(check->CFail(1));
  return "the reader could not convert it";
}

}  // namespace

void findLostIges(const Handle(XSControl_WorkSession) & session, std::vector<brep::Loss>& losses) {
  const Handle(Interface_InterfaceModel) model = session->Model();
  const Handle(Transfer_TransientProcess) made = session->TransferReader()->TransientProcess();
  if (model.IsNull() || made.IsNull()) return;
  const Interface_Graph graph(model);
  for (Standard_Integer i = 1; i <= model->NbEntities(); ++i) {
    const auto entity = IgesEntity::DownCast(model->Value(i));
    const char* word = entity.IsNull() ? nullptr : wordFor(entity->TypeNumber());
    if (word == nullptr) continue;
    const Handle(Transfer_Binder) binder = made->Find(entity);
    if (!binder.IsNull() && !TransferBRep::ShapeResult(binder).IsNull()) continue;
    if (!standsAlone(graph, entity)) continue;
    const Handle(TCollection_HAsciiString) label = model->StringLabel(entity);
    losses.push_back({std::string(word) + " " + (label.IsNull() ? "" : label->ToCString()), reasonFor(entity, binder),
                      0, brep::kNone});
  }
}

}  // namespace hapticd::cad
