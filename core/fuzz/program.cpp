#include "program.h"

#include "bakes.h"
#include "checked.h"
#include "looks.h"
#include "movements.h"
#include "objects.h"
#include "parts.h"
#include "probes.h"

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

namespace lancer_fuzz {

namespace {

// The bytes that select a call for parts. They hardly occur where files from before there were parts select a call, so that
// these keep their meaning: others select by their remainder.
constexpr uint8_t kFirstOfParts = 240, kLastOfParts = 245;
// The bytes that select calls of objects and edits, which old files hardly have either.
constexpr uint8_t kObject = 246, kEdit = 247, kChange = 248;
// The bytes that select calls for compositing, motion and bakes.
constexpr uint8_t kWiden = 249, kMove = 250, kBake = 251;

constexpr uint32_t kMostCalls = 40, kMostScenes = 2, kMostSessions = 3, kMostRanges = 5, kMostRefinements = 4, kMostThings = 16;

// Every byte is read in a statement of its own or in an order that the language defines, so that a file means the same calls
// with every compiler.
class Program {
public:
  Program(const uint8_t *data, size_t size)
      : bytes_(data, size), records_(bytes_), parts_(bytes_, records_, sessions_), objects_(bytes_, records_, scenes_) {}

  void run() {
    for (uint32_t i = 0; i < kMostCalls && bytes_.any(); ++i)
      call();
    finish();
  }

private:
  // Returns the newest handle most often, or an older one, a freed one, or one that never existed.
  template <class State> lancer_scene handle_of(const std::vector<State> &states) {
    const uint8_t b = bytes_.byte();
    if (b >= 253 || states.empty())
      return b == 255 ? 0 : b == 254 ? 0xdeadbeef12345678u : gone_;
    return states[(states.size() - 1 + b / 200) % states.size()].handle;
  }

  void call() {
    const uint8_t b = bytes_.byte();
    if (b >= kFirstOfParts && b <= kLastOfParts)
      return b == kFirstOfParts ? create_session_of_parts() : parts_.call();
    if (b == kObject)
      return objects_.call();
    if (b == kEdit)
      return objects_.edit(handle_of(scenes_), kMostScenes);
    if (b == kChange)
      return objects_.change(handle_of(scenes_));
    if (b == kWiden)
      return records_.widen();
    if (b == kMove)
      return move();
    if (b == kBake)
      return bake();
    switch (b % 24) {
    case 0:
      return create_scene();
    case 1:
    case 2:
      return add_mesh();
    case 3:
      return add_image();
    case 4:
    case 5:
    case 6:
      return add_material();
    case 7:
    case 8:
      return add_light();
    case 9:
    case 10:
    case 11:
      return add_instances();
    case 12:
      return set_world();
    case 13:
      return commit(handle_of(scenes_));
    case 14:
      return wait_for_scene(handle_of(scenes_));
    case 15:
      return end_scene();
    case 16:
      return create_session(handle_of(scenes_));
    case 17:
      return render(handle_of(sessions_));
    case 18:
      return wait_for_session(handle_of(sessions_));
    case 19:
      return judge(handle_of(sessions_));
    case 20:
      return end_session();
    case 21:
      return look(handle_of(sessions_));
    case 22:
      return probe(handle_of(scenes_));
    default:
      return probe_nothing(bytes_);
    }
  }

  // Ends a range, requests its error, or refines by it.
  void judge(lancer_session session) {
    switch (bytes_.below(6)) {
    default:
      LANCER_CHECKED(lancer_session_cancel(session));
      return;
    case 3:
      LANCER_CHECKED(lancer_session_stop(session));
      return;
    case 4: {
      const double confidence = bytes_.number(0.95, 0.0, 1.0);
      return ask_error(session, confidence, bytes_.rarely(2));
    }
    case 5:
      return refine(session);
    }
  }
  void refine(lancer_session session) {
    // Each refinement doubles the samples.
    if (refinements_ == kMostRefinements)
      return;
    ++refinements_;
    const double target = bytes_.number(0.05, 0.0, 1.0), confidence = bytes_.number(0.95, 0.0, 1.0);
    // Parts may bring more samples than there is time to double.
    const SessionState *state = state_of(sessions_, session);
    if (!state || !state->joined)
      LANCER_CHECKED(lancer_session_refine(session, target, confidence));
  }

  void create_scene() {
    if (scenes_.size() == kMostScenes)
      return;
    SceneState scene;
    if (LANCER_CHECKED(lancer_scene_create(bytes_.rarely(2) ? nullptr : &scene.handle)) == LANCER_OK)
      scenes_.push_back(scene);
  }

  // Returns the scene to fill, and its contents; creates one if there is none.
  lancer_scene open(Filled *&filled) {
    static Filled nobodys;
    nobodys = {};
    if (scenes_.empty())
      create_scene();
    const lancer_scene handle = handle_of(scenes_);
    SceneState *state = state_of(scenes_, handle);
    filled = state ? &state->filled : &nobodys;
    return handle;
  }

  void add_mesh() {
    Filled *filled = nullptr;
    const lancer_scene scene = open(filled);
    const lancer_mesh mesh = records_.mesh();
    if (filled->meshes < kMostThings &&
        LANCER_CHECKED(lancer_scene_add_mesh(scene, bytes_.rarely(1) ? nullptr : &mesh)) == LANCER_OK)
      ++filled->meshes;
  }
  void add_image() {
    Filled *filled = nullptr;
    const lancer_scene scene = open(filled);
    const lancer_image image = records_.image();
    if (image.mipmaps && image.width < 1u << 19) {
      // The levels of one row are smaller together than the row.
      std::vector<std::byte> levels(image.width * 4 * sizeof(float));
      LANCER_CHECKED(lancer_make_mipmaps(&image, levels.data()));
    }
    if (filled->images < kMostThings && LANCER_CHECKED(lancer_scene_add_image(scene, &image)) == LANCER_OK)
      ++filled->images;
  }
  void add_material() {
    Filled *filled = nullptr;
    const lancer_scene scene = open(filled);
    const lancer_material material = records_.material(*filled);
    if (filled->materials < kMostThings && LANCER_CHECKED(lancer_scene_add_material(scene, &material)) == LANCER_OK)
      ++filled->materials;
  }
  void add_light() {
    Filled *filled = nullptr;
    const lancer_scene scene = open(filled);
    const lancer_light light = records_.light(*filled);
    if (filled->lights < kMostThings && LANCER_CHECKED(lancer_scene_add_light(scene, &light)) == LANCER_OK)
      ++filled->lights;
  }
  void add_instances() {
    Filled *filled = nullptr;
    const lancer_scene scene = open(filled);
    const Records::Instances instances = records_.instances(*filled);
    const auto count = uint32_t(instances.rows.size());
    if (filled->instances + count > 2 * kMostThings)
      return;
    const lancer_instance *rows = bytes_.rarely(1) ? nullptr : instances.rows.data();
    const uint32_t *slots = bytes_.rarely(1) ? nullptr : instances.slots.data();
    if (LANCER_CHECKED(lancer_scene_add_instances(scene, count, rows, uint32_t(instances.slots.size()), slots, instances.names,
                                                  instances.names_size)) == LANCER_OK)
      filled->instances += count;
  }
  void set_world() {
    Filled *filled = nullptr;
    const lancer_scene scene = open(filled);
    const lancer_world world = records_.world(*filled);
    LANCER_CHECKED(lancer_scene_set_world(scene, &world));
  }

  void move() {
    Filled *filled = nullptr;
    const lancer_scene scene = open(filled);
    lancer_fuzz::move(scene, filled, records_, bytes_);
  }

  void bake() {
    if (sessions_.size() >= kMostSessions || !make_ready())
      return;
    const lancer_scene scene = handle_of(scenes_);
    const SceneState *state = state_of(scenes_, scene);
    const SessionState session = lancer_fuzz::bake(scene, state ? &state->filled : nullptr, records_, bytes_);
    if (session.handle != 0)
      sessions_.push_back(session);
  }

  void commit(lancer_scene scene) {
    const uint32_t accelerator = bytes_.choice(3), threads = bytes_.rarely(2) ? 1025 : 1 + bytes_.below(2);
    if (LANCER_CHECKED(lancer_scene_commit(scene, accelerator, threads)) == LANCER_OK)
      state_of(scenes_, scene)->committed = true;
  }
  void wait_for_scene(lancer_scene scene) {
    LANCER_CHECKED(lancer_scene_wait(scene, bytes_.below(3)));
    size_t needed = 0;
    std::string text(bytes_.byte(), '?');
    const lancer_status status = LANCER_CHECKED(lancer_scene_messages(scene, text.data(), text.size(), &needed));
    if (status == LANCER_OK && !text.empty() && std::memchr(text.data(), 0, text.size()) == nullptr)
      broken("lancer_scene_messages", "its text is not terminated");
  }
  void end_scene() {
    const lancer_scene scene = handle_of(scenes_);
    if (bytes_.rarely(100)) {
      LANCER_CHECKED(lancer_scene_cancel(scene));
      return;
    }
    if (LANCER_CHECKED(lancer_scene_destroy(scene)) != LANCER_OK)
      return;
    gone_ = scene;
    std::erase_if(scenes_, [&](const SceneState &state) { return state.handle == scene; });
  }

  void create_session(lancer_scene scene) {
    if (sessions_.size() >= kMostSessions)
      return;
    const lancer_camera camera = records_.camera();
    const lancer_settings settings = records_.settings();
    SessionState session{0, camera, settings};
    if (LANCER_CHECKED(lancer_session_create(scene, &camera, &settings, &session.handle)) == LANCER_OK)
      sessions_.push_back(session);
  }
  void render(lancer_session session) {
    SessionState *state = state_of(sessions_, session);
    const uint32_t first = bytes_.rarely(10) ? bytes_.word() : state ? state->samples : 0, count = 1 + bytes_.below(2);
    if (ranges_ == kMostRanges || (state && state->slow) ||
        LANCER_CHECKED(lancer_session_render(session, first, count)) != LANCER_OK)
      return;
    ++ranges_;
    state->samples += count;
  }
  void wait_for_session(lancer_session session) {
    lancer_progress progress = {};
    const lancer_status status = LANCER_CHECKED(lancer_session_wait(session, bytes_.below(3), &progress));
    if (status <= LANCER_CANCELLED && !(progress.fraction >= 0.0 && progress.fraction <= 1.0))
      broken("lancer_session_wait", "its fraction is not in 0 ... 1");
  }
  void end_session() {
    const lancer_session session = handle_of(sessions_);
    if (LANCER_CHECKED(lancer_session_destroy(session)) != LANCER_OK)
      return;
    gone_ = session;
    std::erase_if(sessions_, [&](const SessionState &state) { return state.handle == session; });
  }

  void look(lancer_session session) { lancer_fuzz::look(session, state_of(sessions_, session), bytes_); }
  void probe(lancer_scene scene) {
    const SceneState *state = state_of(scenes_, scene);
    probe_scene(scene, state ? &state->filled : nullptr, bytes_);
  }

  // Fills and commits the newest scene unless that is done. Returns whether it can be rendered.
  bool make_ready() {
    if (scenes_.empty())
      create_scene();
    if (scenes_.empty())
      return false;
    // An empty scene tests nothing.
    if (!scenes_.back().committed && scenes_.back().filled.instances == 0) {
      add_material();
      add_instances();
      add_light();
    }
    const SceneState scene = scenes_.back();
    if (!scene.committed)
      commit(scene.handle);
    lancer_status status;
    while ((status = LANCER_CHECKED(lancer_scene_wait(scene.handle, 50))) == LANCER_RUNNING)
      ;
    return status == LANCER_OK;
  }

  void create_session_of_parts() {
    make_ready();
    parts_.create_session(bytes_.rarely(10) || scenes_.empty() ? handle_of(scenes_) : scenes_.back().handle);
  }

  // Continues to the end: a scene, a commit, a session, a range, its picture.
  void finish() {
    if (make_ready()) {
      create_session(scenes_.back().handle);
      for (const SessionState &session : std::vector<SessionState>(sessions_)) {
        wait_for_end(session.handle);
        render(session.handle);
        wait_for_end(session.handle);
        look(session.handle);
      }
      probe(scenes_.back().handle);
    }
    for (const SessionState &session : sessions_)
      LANCER_CHECKED(lancer_session_destroy(session.handle));
    for (const SceneState &each : scenes_)
      LANCER_CHECKED(lancer_scene_destroy(each.handle));
  }

  Bytes bytes_;
  Records records_;
  std::vector<SceneState> scenes_;
  std::vector<SessionState> sessions_;
  Parts parts_;
  Objects objects_;
  uint64_t gone_ = 7;
  uint32_t refinements_ = 0;
  uint32_t ranges_ = 0;
};

} // namespace

void run_program(const uint8_t *data, size_t size) { Program(data, size).run(); }

} // namespace lancer_fuzz
