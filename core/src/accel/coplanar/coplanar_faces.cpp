#include "accel/coplanar/coplanar_faces.h"

#include "accel/coplanar/flat_face.h"
#include "simd/parallel.h"

namespace lancer {

namespace {

// Largest numbers of comparisons per face: of boxes, and of faces whose boxes overlap. They bound the effort for many instances
// at one place.
constexpr size_t kBoxes = 256, kPairs = 32;
// Number of coplanar faces after which a face counts as heaped: two heaped faces are not compared.
constexpr uint32_t kOthers = 64;
// Largest numbers of faces that are looked at, and of those that are compared, to complete the planes of instances of which
// some faces are compared.
constexpr size_t kScanned = 1 << 20, kAdded = 1 << 14;
// Limit of patches over all faces; beyond it faces count as covered anywhere.
constexpr size_t kPatches = 1 << 17;

// The part of a face that another covers.
struct Patch {
  uint64_t face; // instance and primitive
  CoverPatch where;
};

uint64_t number_of(const FaceCandidate &c) { return uint64_t{c.instance} << 32 | c.primitive; }

class Finder {
public:
  Finder(const GeometryView &g, const FaceRounding &r, const PlaneRules &known, const BuildContext &c)
      : geometry(g), rounding(r), rules(known), context(c), chosen(choose_faces(g, r, c)), candidates(chosen.faces) {}

  CoplanarFaces find() {
    complete_ = compare() && complete();
    CoplanarFaces faces;
    mark(faces);
    if (complete_)
      cover(faces);
    return faces;
  }

private:
  struct Entry {
    uint64_t cell;
    double low;
    uint32_t candidate;
  };

  // Compares candidates, unless both have been compared before. Returns false if there are too many pairs: what is found is
  // then extrapolated.
  bool compare() {
    const bool all = compare_pairs();
    if (!all)
      spread();
    return all;
  }

  bool compare_pairs() {
    std::vector<Entry> entries;
    for (uint32_t i = 0; i < candidates.size(); ++i)
      for_each_plane_cell(candidates[i].face, candidates[i].rounding, chosen.step, [&](uint64_t cell) {
        entries.push_back({cell, candidates[i].low.x, i});
      });
    std::sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) {
      return a.cell != b.cell ? a.cell < b.cell : a.low != b.low ? a.low < b.low : a.candidate < b.candidate;
    });
    size_t boxes = kBoxes * entries.size(), pairs = kPairs * entries.size();
    for (size_t i = 0; i < entries.size(); ++i) {
      FaceCandidate &one = candidates[entries[i].candidate];
      for (size_t k = i + 1; k < entries.size() && entries[k].cell == entries[i].cell && entries[k].low <= one.high.x; ++k) {
        FaceCandidate &other = candidates[entries[k].candidate];
        if (boxes-- == 0 || pairs == 0)
          return false;
        if (!(one.fresh || other.fresh) || !boxes_meet(one.low, one.high, other.low, other.high) || same_border(one, other))
          continue;
        if (one.found >= kOthers && other.found >= kOthers) {
          one.anywhere = other.anywhere = true;
          continue;
        }
        --pairs;
        if (!in_one_plane(rounding, one, other))
          continue;
        add_patch(one, other);
        add_patch(other, one);
      }
    }
    return true;
  }

  // Extrapolates an incomplete comparison: if one face of an instance has a coplanar face, any compared face of the instance
  // may have one.
  void spread() {
    std::vector<uint8_t> found(geometry.instances.size(), 0);
    for (const FaceCandidate &c : candidates)
      found[c.instance] |= c.found > 0;
    for (FaceCandidate &c : candidates)
      c.found |= found[c.instance];
  }

  void add_patch(FaceCandidate &c, const FaceCandidate &by) {
    ++c.found;
    c.anywhere = c.anywhere || patches.size() >= kPatches;
    if (c.anywhere)
      return;
    // A place counts as covered up to the rounding distance from the patch.
    CoverPatch patch =
        make_patch(coordinates_on_face(geometry, c.instance, c.primitive), c.corner, by.corner, c.rounding + by.rounding);
    patch.loses =
        plane_order(geometry, rules, by.instance, by.primitive) < plane_order(geometry, rules, c.instance, c.primitive);
    patches.push_back({number_of(c), patch});
  }

  // Returns whether two faces are neighbours in a mesh, as most coplanar faces are.
  bool same_border(const FaceCandidate &one, const FaceCandidate &other) const {
    if (one.instance != other.instance)
      return false;
    const Instance &instance = geometry.instances[one.instance];
    if (instance.kind != ShapeKind::Mesh || one.primitive == other.primitive)
      return true;
    const MeshView &mesh = geometry.meshes[instance.mesh];
    const glm::uvec3 &a = mesh.triangles[one.primitive], &b = mesh.triangles[other.primitive];
    int shared = 0;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        shared += a[i] == b[k];
    return shared == 1 || shared == 2;
  }

  // Calls use(instance, begin, end, found) with the candidates of each instance of which some are coplanar with others.
  template <class Use> void each_instance(Use &&use) const {
    for (size_t begin = 0, end; begin < candidates.size(); begin = end) {
      const uint32_t instance = candidates[begin].instance;
      size_t found = 0;
      for (end = begin; end < candidates.size() && candidates[end].instance == instance; ++end)
        found += candidates[end].found > 0;
      if (found > 0)
        use(instance, begin, end, found);
    }
  }

  // Compares the other faces in the planes of coplanar faces, too. Returns false if there are too many of them: then any face
  // in such a plane may be coplanar with others.
  bool complete() {
    std::vector<FaceCandidate> added;
    size_t scanned = 0;
    each_instance([&](uint32_t instance, size_t begin, size_t end, size_t found) {
      const size_t count = faces_of(geometry, instance);
      scanned += count <= end - begin ? 0 : count;
      if (count <= end - begin || scanned > kScanned || added.size() > kAdded)
        return;
      std::vector<uint64_t> bits((count + 63) / 64, 0);
      mark_planes(instance, begin, end, found, bits.data());
      for (size_t i = begin; i < end; ++i)
        bits[candidates[i].primitive >> 6] &= ~(uint64_t{1} << (candidates[i].primitive & 63));
      for (size_t word = 0; word < bits.size(); ++word)
        for (uint64_t rest = bits[word]; rest != 0; rest &= rest - 1) {
          const auto primitive = uint32_t(64 * word + size_t(std::countr_zero(rest)));
          glm::dvec3 corner[3];
          world_corners(geometry, instance, primitive, corner);
          if (const auto candidate = face_candidate(rounding, instance, primitive, corner))
            added.push_back(*candidate);
        }
    });
    if (scanned > kScanned || added.size() > kAdded)
      return false;
    if (added.empty())
      return true;
    for (FaceCandidate &c : candidates)
      c.fresh = false;
    candidates.insert(candidates.end(), added.begin(), added.end());
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const FaceCandidate &a, const FaceCandidate &b) { return number_of(a) < number_of(b); });
    return compare();
  }

  void mark(CoplanarFaces &faces) const {
    each_instance([&](uint32_t instance, size_t begin, size_t end, size_t found) {
      if (!faces.any()) {
        faces.instances.assign(geometry.instances.size(), 0);
        faces.first.assign(geometry.instances.size(), 0);
      }
      faces.instances[instance] = 1;
      faces.first[instance] = static_cast<uint32_t>(faces.bits.size());
      const size_t count = faces_of(geometry, instance);
      faces.bits.resize(faces.bits.size() + (count + 63) / 64, 0);
      uint64_t *bits = &faces.bits[faces.first[instance]];
      if (complete_ || count <= end - begin)
        for (size_t i = begin; i < end; ++i)
          bits[candidates[i].primitive >> 6] |= uint64_t{candidates[i].found > 0} << (candidates[i].primitive & 63);
      else
        mark_planes(instance, begin, end, found, bits);
    });
  }

  // Marks those faces of an instance that were not compared but lie in the plane of a coplanar face that was found.
  void mark_planes(uint32_t instance, size_t begin, size_t end, size_t found, uint64_t *bits) const {
    // Mark all faces of an instance if many of its compared faces are coplanar with others.
    const bool all = found * 8 > end - begin;
    std::vector<uint64_t> cells;
    for (size_t i = begin; i < end; ++i)
      if (candidates[i].found > 0)
        for_each_plane_cell(candidates[i].face, candidates[i].rounding, chosen.step,
                            [&](uint64_t cell) { cells.push_back(cell); });
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    const size_t count = faces_of(geometry, instance);
    constexpr size_t kPiece = 16384;
    parallel_for(context, (count + kPiece - 1) / kPiece, [&](size_t piece) {
      for (size_t i = piece * kPiece; i < std::min((piece + 1) * kPiece, count); ++i) {
        bool in = all;
        if (!in) {
          glm::dvec3 corner[3];
          world_corners(geometry, instance, static_cast<uint32_t>(i), corner);
          for_each_plane_cell(triangle_face(corner), rounding.share(instance, corner[0]), chosen.step,
                              [&](uint64_t cell) { in = in || std::binary_search(cells.begin(), cells.end(), cell); });
        }
        bits[i >> 6] |= uint64_t{in} << (i & 63);
      }
    });
  }

  // Records the covered parts of the faces, so that rays search for coplanar faces only there.
  void cover(CoplanarFaces &faces) {
    uint32_t marked = 0;
    for (const uint64_t word : faces.bits) {
      faces.ranks.push_back(marked);
      marked += static_cast<uint32_t>(std::popcount(word));
    }
    std::stable_sort(patches.begin(), patches.end(), [](const Patch &a, const Patch &b) { return a.face < b.face; });
    std::vector<CoverPatch> own;
    // Bits are in the order of candidates, with the two halves of a face together.
    for (size_t begin = 0, end; begin < candidates.size(); begin = end) {
      const uint64_t face = number_of(candidates[begin]);
      bool found = false, anywhere = false;
      for (end = begin; end < candidates.size() && number_of(candidates[end]) == face; ++end) {
        found = found || candidates[end].found > 0;
        anywhere = anywhere || candidates[end].anywhere;
      }
      if (!found)
        continue;
      own.clear();
      for (auto at = std::lower_bound(patches.begin(), patches.end(), face,
                                      [](const Patch &patch, uint64_t number) { return patch.face < number; });
           at != patches.end() && at->face == face; ++at)
        own.push_back(at->where);
      if (anywhere)
        faces.cover.add_face_covered_anywhere();
      else
        faces.cover.add_face(own, coordinates_on_face(geometry, candidates[begin].instance, candidates[begin].primitive));
    }
  }

  const GeometryView geometry;
  const FaceRounding &rounding;
  const PlaneRules &rules;
  const BuildContext &context;
  FaceCandidates chosen;
  std::vector<FaceCandidate> &candidates;
  std::vector<Patch> patches;
  bool complete_ = false; // all faces that may be coplanar with others have been compared
};

} // namespace

CoplanarFaces find_coplanar_faces(const GeometryView &geometry, const FaceRounding &rounding, const PlaneRules &rules,
                                  const BuildContext &context) {
  return Finder(geometry, rounding, rules, context).find();
}

} // namespace lancer
