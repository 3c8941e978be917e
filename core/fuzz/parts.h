// Calls for parts of pictures: sessions that render and join them, and parts that are whole, damaged or made up.
#pragma once

#include "states.h"

#include <cstdint>
#include <vector>

namespace lancer_fuzz {

using Part = std::vector<uint8_t>;

class Parts {
public:
  Parts(Bytes &bytes, Records &records, std::vector<SessionState> &sessions)
      : bytes_(bytes), records_(records), sessions_(sessions) {}

  // Names the scene, and creates a session of it. scene: committed, or not.
  void create_session(lancer_scene scene);
  // Calls with mostly one of the sessions.
  void call();

private:
  void create_joiner(lancer_session like);
  void ask_tiles(lancer_session session);
  void decide(lancer_session session);
  void plan(lancer_session session);
  void render(lancer_session session);
  void clear(lancer_session session);
  void keep(lancer_session session);
  void join_again(lancer_session session);
  void import(lancer_session session);

  // Returns one of the sessions, or one that never existed.
  lancer_session any_session();
  bool full() const;
  // Returns a part from before, mostly the newest.
  Part part();

  Bytes &bytes_;
  Records &records_;
  std::vector<SessionState> &sessions_;
  std::vector<Part> parts_;
  uint32_t ranges_ = 0;
};

} // namespace lancer_fuzz
