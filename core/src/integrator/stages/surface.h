// Surfaces and their lobes at hits, in lanes.
//
// In: rays, their hits, materials of one class, and the views from which nodes see them, from an integrator. Out: the surface
// and its lobes, for the stages light, scatter, occlusion and shadow; emission, transmittance, holes and means of lobes, for
// the integrator and the occlusion stage. Callers: all integrators. Lengths are in the normalised world. The steps of a block:
//
//   add() each hit or replace() its surface, then find(), ask_nodes() (nodes/run.h), cut_holdouts(), build_lobes()
//   (bsdf/material_lobes.h), describe() where passes need it; clear() at the end. After move() or view_along(), find() again.
#pragma once

#include "integrator/sample.h"
#include "integrator/stages/lobe_means.h"
#include "nodes/run.h"
#include "simd/block.h"

namespace lancer {

// Hits on triangles and exact surfaces.
struct alignas(64) HitBlock {
  const double *placement[kBlockLanes]; // Instance::to_world and the following members
  Floats corner[3][3], normals[3][3];   // of a triangle's corners, object space; by corner, axis
  Doubles bary[2], d[3], o[3], t;       // of the ray, d of any length; o and t only for exact surfaces
  // Each of the following is one bit per lane.
  uint32_t used = 0;
  uint32_t on_mesh = 0, smooth = 0; // triangles; those with smooth normals
  uint32_t exact = 0;               // exact surfaces: the following shapes, and spheres
  uint32_t on_plane = 0, on_cylinder = 0, on_cone = 0;
};

// The members of Surface, with both normals outwards. wo: unit, towards the viewer; length: of d; terminator:
// Instance::terminator, 0 on exact surfaces.
struct alignas(64) SurfaceBlock {
  Doubles p[3], offset, length;
  Floats ng[3], ns[3], wo[3];
  Floats terminator;
  Floats time; // of the ray; by add() and replace()
};

// The materials at the surfaces, and what their nodes say.
struct alignas(64) MaterialBlock {
  const MaterialView *material[kBlockLanes];       // all of one class
  Floats transmittance[3];                         // by describe()
  Floats through;                                  // by add() and ask_nodes(): the mean of the transmittance
  const float (*values)[4][kBlockLanes] = nullptr; // of nodes, four floats for every lane, by ask_nodes()
  uint32_t holes = 0;                              // bits of lanes: lobes are hidden by a hole; by cut_holdouts()
  uint32_t ends = 0;                               // bits of lanes: the surface scatters no light
  uint32_t seen_by_camera = 0;                     // bits of lanes, by add()
  bool walks = false;                              // surfaces may send paths below them; by walk_below()
  bool leaving = false;                            // all lanes come from below; by place_path()
  uint32_t after_diffuse = 0;                      // bits of lanes: a diffuse lobe has scattered the path; by place_path()
  uint32_t dimmed = 0;                             // bits of lanes: Fresnel's weight dims the exit from below; by place_path()
  Floats pixel;                                    // width of a pixel there, user's units; by place_path()
  Words key;                                       // of the numbers of estimates; by set_key()
  // The limits of paths, by limit(): bits of lanes that lack caustics, or have nothing else; the least alpha of glossy lobes.
  bool no_reflections = false, no_refractions = false, blurs = false; // the settings
  uint32_t no_caustics = 0, only_caustics = 0;
  Floats least_alpha;
  uint32_t even_choices = 0; // bits of lanes: each way on has a least share of the choices; by even_choices()
  uint32_t lacks = 0;        // bits of components whose lobes are absent; by lack()
  bool shares = false;       // diffuse and glossy shares of light are wanted
  bool spreads = false;      // the spread of rays is wanted, for images with mipmaps
};

// The lobes, with normals and emission on the viewer's side; by build_lobes().
struct alignas(64) LobeBlock {
  Floats ns[3], ng[3];
  Floats emission[3];           // of layered lobes; SurfaceStage::emission() adds that of the material
  Floats pass;                  // share of paths that pass straight through; the others are scattered
  Floats straight[3];           // in lanes of sheets: Bsdf::straight
  std::byte *storage = nullptr; // of the lobes of all lanes: see lobe_lanes.h
  // Each of the following is one bit per lane.
  uint32_t used = 0;
  uint32_t transmits = 0; // some lobe scatters light to the other side
  uint32_t scatters = 0;  // into more than single directions
  uint32_t enters = 0;    // some light enters the surface, to walk below it
  uint32_t sheets = 0;    // some light passes a smooth sheet straight
  bool shares = false;    // as in MaterialBlock
  bool spreads = false;   // as in MaterialBlock
  Floats widest;          // largest alpha_x alpha_y of a lobe that scatters into more than single directions, where wanted
};

// Means over lobes that passes ask for.
struct MeansWanted {
  bool normal = false, matt_normal = false, shown = false, mixture = false;
  bool blended = false;         // Mixture by the rule of Blender 5.2
  float bare_roughness = -1.0f; // of bakes, where no lobe counts; negative: no bake
};
struct alignas(64) MeanBlock {
  Floats normal[3], matt_normal[3]; // mean normals of all lobes and of the diffuse ones
  Floats shown[3][3];               // colours of the passes, by component
  Floats mixed_matt, mixed_all, mixed_roughness, mixed_diffuse[3], mixed_specular[3],
      mixed_normal[3]; // Mixture of lobe_means.h
};

struct SurfaceKernel {
  // Lanes without a shape bit keep their surface, but for wo and length.
  void (*find)(const HitBlock &hits, SurfaceBlock &surfaces);
  void (*build)(const SurfaceBlock &surfaces, const MaterialBlock &materials, LobeBlock &lobes);
  void (*describe)(const MaterialBlock &materials, const LobeBlock &lobes, const MeansWanted &wanted, MeanBlock &means);
  size_t lobes_bytes;
};
LANCER_DECLARE_KERNEL(SurfaceKernel, surface_kernel)

class SurfaceStage {
public:
  SurfaceStage(const Scene &scene, const Camera &camera, const IntegratorSettings &settings);
  SurfaceStage(const SurfaceStage &) = delete; // its blocks have the address of its values
  SurfaceStage &operator=(const SurfaceStage &) = delete;

  uint32_t count() const { return count_; }
  bool full() const { return count_ == kBlockLanes; }
  // Adds a hit to the next lane and returns the lane. All hits of a block have materials of one class; ray and hit must stay in
  // place until clear(). ends: the surface scatters no light; the path ends here or passes straight on.
  uint32_t add(const Ray &ray, const Hit &hit, const MaterialView &material, bool ends = false);
  // Replaces the surface of a lane, seen along a view direction of any length.
  void replace(uint32_t lane, const Surface &surface, const glm::dvec3 &view);
  // Moves a lane to another place of its triangle.
  void move(uint32_t lane, const Hit &hit);
  // Turns a lane to be seen along a view direction of any length.
  void view_along(uint32_t lane, const glm::dvec3 &view) { put(view, hits_.d, lane); }
  // Lets surfaces send paths below them.
  void walk_below() { materials_.walks = true; }
  // Describes the path of a lane to lobes that send paths below: whether a diffuse lobe has scattered it, whether it comes from
  // below, as all of its block then do, whether Fresnel's weight dims its exit, and the width of a pixel where it meets the
  // surface, in the user's units.
  void place_path(uint32_t lane, bool after_diffuse, bool leaving, bool dimmed, float pixel) {
    materials_.after_diffuse |= uint32_t{after_diffuse} << lane;
    materials_.dimmed |= uint32_t{dimmed} << lane;
    materials_.leaving = leaving;
    materials_.pixel[lane] = pixel;
  }
  // Whether paths may lack caustics, or meet blurred lobes, so that limit() is needed.
  bool limits() const { return materials_.no_reflections | materials_.no_refractions | materials_.blurs; }
  // Limits the lobes of a lane: without the caustics that the settings leave out, or with these alone; with glossy lobes of at
  // least this alpha.
  void limit(uint32_t lane, bool no_caustics, bool only_caustics, float least_alpha) {
    materials_.no_caustics |= uint32_t{no_caustics} << lane;
    materials_.only_caustics |= uint32_t{only_caustics} << lane;
    materials_.least_alpha[lane] = least_alpha;
  }
  // Gives each way on from a lane's surface a least share of the choices.
  void even_choices(uint32_t lane) { materials_.even_choices |= 1u << lane; }
  // Leaves the lobes of these components out of a block, bits.
  void lack(uint32_t components) { materials_.lacks = components; }
  // Sets the key of the random numbers by which the lobes of a lane estimate their values, where the material has any such.
  void set_key(uint32_t lane, uint32_t key) { materials_.key[lane] = key; }
  // Lets nodes look around by these rays, which must outlive the stage.
  void look_by(const NodeRays &rays) { looking_.rays = &rays; }
  // Computes the surfaces of all lanes.
  void find();
  // Evaluates the nodes of the material, if it has any. view_of(lane): returns the View of a lane.
  // asks_outputs: also those of its outputs.
  template <class ViewOf> void ask_nodes(ViewOf &&view_of, bool asks_outputs = false) {
    const MaterialView &material = *materials_.material[0];
    if (material.fixed() || (materials_.leaving && !material.bends_exits))
      return;
    outputs_asked_ = asks_outputs && !material.output_nodes.empty();
    View views[kBlockLanes];
    for (uint32_t lane = 0; lane < count_; ++lane)
      views[lane] = view_of(lane);
    run_nodes(views);
  }
  // Returns the width of a pixel at the end of a path of length `way`, in the user's units.
  float pixel_width(double way) const { return float((cone_.base + way * cone_.spread) / scene_.normalisation.scale); }
  // Returns the view of a lane at the end of a path of length `way`.
  View view(uint32_t lane, double way, const LightPath<float> &path) const {
    return {.wo = get(surfaces_.wo, lane), .footprint = float(cone_.base + way * cone_.spread), .path = path};
  }
  // Cuts holdouts out of those lanes that the camera sees: a hole has neither lobes nor emission. Returns bits of lanes: those
  // that are cut, and those of which nothing is left.
  struct Holes {
    uint32_t cut = 0, nothing = 0;
  };
  Holes cut_holdouts(uint32_t seen);
  // Returns the alpha that a hole takes from a pixel. beta: throughput from the surface to the camera.
  float cut_alpha(uint32_t lane, const glm::vec3 &beta) const;
  // Shows all surfaces as opaque in transmittance(); the lobes' share of paths that pass straight through stays.
  void make_opaque();
  void build_lobes();
  // Lets no path of the block pass straight on; transmittance() stays.
  void stop_straight() { std::fill_n(lobes_.pass, kBlockLanes, 0.0f); }
  // Computes the means of the lobes that passes need; means() and mixture() are those of the last call.
  void describe();
  void clear();

  const SurfaceBlock &surfaces() const { return surfaces_; }
  const LobeBlock &lobes() const { return lobes_; }
  const MeanBlock &means() const { return means_; }
  const MaterialView &material(uint32_t lane) const { return *materials_.material[lane]; }
  const Ray &ray(uint32_t lane) const { return *ray_of_[lane]; }
  const Hit &hit(uint32_t lane) const { return *hit_of_[lane]; }
  // Returns the instance of a lane as it stands; moved or not.
  const Instance &instance(uint32_t lane) const { return scene_.geometry.instances[hit(lane).instance]; }
  // Returns the distance from the origin of a lane's ray to its hit.
  double distance(uint32_t lane) const { return hit(lane).t * surfaces_.length[lane]; }
  Surface surface(uint32_t lane) const;
  glm::vec3 value(const Parameter &parameter, uint32_t lane) const;
  // Returns the radiance that a lane emits towards its viewer.
  glm::vec3 emission(uint32_t lane) const { return emission_[lane] + get(lobes_.emission, lane); }
  glm::vec3 transmittance(uint32_t lane) const { return transmittance_[lane]; }
  // Returns 1 minus the transmittance, in 0 ... 1.
  glm::vec3 opacity(uint32_t lane) const { return glm::clamp(1.0f - transmittance_[lane], 0.0f, 1.0f); }
  Mixture<float> mixture(uint32_t lane) const;
  uint32_t holes() const { return materials_.holes; } // bits of lanes

  // The places of a block's lanes, kept while move() or view_along() has taken the lanes elsewhere.
  struct Places {
    HitBlock hits;
    SurfaceBlock surfaces;
    LobeBlock lobes;
  };
  Places places() const { return {hits_, surfaces_, lobes_}; }
  void go_back(const Places &places);

private:
  void run_nodes(std::span<const View> views);
  void place_nodes(const MaterialView &material, std::span<const View> views);
  void set_transmittance(uint32_t lane, const glm::vec3 &transmittance);
  float holdout(uint32_t lane) const;

  // Storage of the lobes.
  struct alignas(64) Bytes {
    std::byte of[64];
  };

  const SurfaceKernel &kernel_;
  const NodeKernel &node_kernel_;
  const Scene &scene_;
  PixelCone cone_;
  const MeansWanted wanted_;
  uint32_t count_ = 0;
  bool outputs_asked_ = false;
  const Ray *ray_of_[kBlockLanes];
  const Hit *hit_of_[kBlockLanes];
  HitBlock hits_{};
  SurfaceBlock surfaces_{};
  MaterialBlock materials_{};
  LobeBlock lobes_{};
  MeanBlock means_{};
  glm::vec3 emission_[kBlockLanes], transmittance_[kBlockLanes]; // of the material
  NodeBlock nodes_{};
  LookingLanes looking_{};
  MovedLanes moved_{};
  std::vector<Instance> placed_; // by lane, at the time of its ray; empty where nothing moves
  std::vector<NodeLanes> values_;
  std::vector<Bytes> storage_;
};

} // namespace lancer
