// Schedules: the nodes that parameters depend on.
#include "scene/node.h"

namespace lancer {

namespace {

void mark(const Parameter &parameter, std::vector<bool> &needed) {
  if (parameter.varies())
    needed[size_t(parameter.node)] = true;
}

} // namespace

Schedule ProgramView::schedule(std::span<const Parameter> parameters) const {
  std::vector<bool> needed(nodes.size());
  for (const Parameter &parameter : parameters)
    mark(parameter, needed);
  // Nodes refer to earlier ones only: one backward pass visits every user before its inputs.
  for (size_t i = nodes.size(); i-- > 0;) {
    if (!needed[i])
      continue;
    const Node &node = nodes[i];
    for (int k = 0; k < 5; ++k) {
      const bool height = node.kind == NodeKind::Bump && k == 2;
      if (!height || node.inputs[k].node < int32_t(node.first))
        mark(node.inputs[k], needed);
    }
    if (node.kind != NodeKind::Bump)
      continue;
    // A bump evaluates its own height nodes. Their inputs from earlier nodes belong to this schedule.
    for (const uint16_t number : heights_of(node)) {
      const Node &inner = nodes[number];
      for (int k = 0; k < 5; ++k)
        if (is_read_in_height(inner, k) && inner.inputs[k].node < int32_t(node.first))
          mark(inner.inputs[k], needed);
    }
  }
  Schedule result;
  for (size_t i = 0; i < nodes.size(); ++i)
    if (needed[i])
      result.push_back(uint16_t(i));
  return result;
}

namespace {

// Whether the values of a kind change from pixel to pixel as far as levels of images go; see nodes/changes.h.
bool changes(const Node &node) {
  switch (node.kind) {
  case NodeKind::Coordinate:
  case NodeKind::Attribute:
  case NodeKind::Mapping:
  case NodeKind::VectorMath:
  case NodeKind::Separate:
  case NodeKind::Combine:
  case NodeKind::Grey:
  case NodeKind::Transform:
    return true;
  default:
    return false;
  }
}

} // namespace

void Program::number_changes() {
  std::vector<bool> needed(nodes.size());
  for (size_t i = nodes.size(); i-- > 0;) {
    Node &node = nodes[i];
    mipmapped |= node.mipmapped;
    const bool moves = needed[i] && !node.steady && changes(node);
    if (moves)
      node.changes = int32_t(nodes.size() + 2 * changing++);
    if (moves || node.mipmapped)
      for (const Parameter &input : node.inputs)
        mark(input, needed);
  }
}

bool looks_around(uint32_t kind) { return kind == NodeKind::Occlusion || kind == NodeKind::Bevel || kind == NodeKind::Raycast; }

bool asks_no_place(uint32_t kind) {
  switch (kind) {
  case NodeKind::Alpha:
  case NodeKind::Mapping:
  case NodeKind::Math:
  case NodeKind::VectorMath:
  case NodeKind::Mix:
  case NodeKind::Separate:
  case NodeKind::Combine:
  case NodeKind::Grey:
  case NodeKind::Clamp:
  case NodeKind::Gamma:
  case NodeKind::Invert:
  case NodeKind::ColorModel:
    return true;
  default:
    return false;
  }
}

} // namespace lancer
