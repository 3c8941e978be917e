// A part of a picture made up byte by byte, as lancer.h documents it, with checksums that fit: for parts that no session
// writes.
#pragma once

#include "parts_lab.h"

#include "render/checksum.h"
#include "render/part_format.h"
#include "render/parts.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace lancer_test {

// A picture of one square, which is two tiles of 15 pixels, with four summed channels and the depth of sample 0.
inline constexpr uint32_t kMadeWidth = 6, kMadeHeight = 5, kMadePixels = 15;

inline lancer_settings made_settings() {
  lancer_settings settings = settings_of_parts();
  settings.passes = 1u << LANCER_PASS_COMBINED | 1u << LANCER_PASS_DEPTH;
  return settings;
}

// The sums of a tile, equal in all pixels.
struct MadeTile {
  uint32_t tile = 0;
  struct Node {
    uint32_t start, level;
    double sum;
  };
  std::vector<Node> nodes = {{0, 1, 1.0}};
  float difference = 0.25f, brightest = 0.75f, depth = 3.0f;
  std::vector<uint64_t> dropped = {};
  uint32_t first_dropped[3] = {0, 0, 0};
  // The numbers in its head.
  uint32_t told_nodes = 1, told_dropped = 0, told_first = 1;

  void tell() {
    told_nodes = uint32_t(nodes.size());
    told_dropped = uint32_t(dropped.size());
    told_first = !nodes.empty() && nodes.front().start == 0;
  }
};

struct Made {
  lancer_part description{};
  uint64_t counts[4] = {30, 20, 10, 40};
  int64_t digits[10][32] = {};
  std::vector<MadeTile> tiles;

  explicit Made(std::vector<MadeTile> of = {MadeTile()}) : tiles(std::move(of)) {
    std::copy_n(kDigest, sizeof kDigest, description.digest);
    std::snprintf(description.release, sizeof description.release, "%s", lancer_version());
    description.camera = make_camera(kMadeWidth, kMadeHeight);
    description.settings = made_settings();
    description.split_lights = description.settings.split_lights;
    description.split_paths = description.settings.split_paths;
    description.tiles = tiles.size();
    description.first = tiles.empty() ? 0 : ~0u;
    for (MadeTile &tile : tiles) {
      tile.tell();
      for (const MadeTile::Node &node : tile.nodes) {
        description.samples += (uint64_t(1) << node.level) * kMadePixels;
        description.first = std::min(description.first, node.start);
        description.end = std::max(description.end, node.start + (1u << node.level));
      }
    }
  }

  Bytes bytes() const {
    Bytes bytes;
    const auto put = [&](const auto &value) {
      const auto *from = reinterpret_cast<const uint8_t *>(&value);
      bytes.insert(bytes.end(), from, from + sizeof value);
    };
    const auto put_pixels = [&](auto value, uint32_t count) {
      for (uint32_t i = 0; i < kMadePixels * count; ++i)
        put(value);
    };
    lancer_part told = description;
    lancer::Identity identity{{}, true, told.camera, told.settings};
    std::copy_n(told.release, identity.release.size(), identity.release.begin());
    std::copy_n(told.digest, sizeof told.digest, identity.digest.begin());
    told.hash = identity.hash();
    for (const char letter : {'L', 'A', 'N', 'C', 'E', 'R', 'P', 'T'})
      put(letter);
    put(lancer::kPartFormat);
    put(uint32_t(LANCER_ABI_VERSION));
    put(uint64_t(0));
    put(told);
    put(counts);
    put(digits);
    for (const MadeTile &tile : tiles) {
      for (const uint32_t number : {tile.tile, tile.told_nodes, tile.told_dropped, tile.told_first})
        put(number);
      for (const MadeTile::Node &node : tile.nodes)
        for (const uint32_t number : {node.start, node.level})
          put(number);
      for (const MadeTile::Node &node : tile.nodes) {
        put_pixels(node.sum, 4);
        put_pixels(node.level > 0 ? tile.difference : 0.0f, 1);
      }
      put_pixels(tile.brightest, 1);
      put_pixels(tile.depth, tile.told_first);
      for (const uint64_t number : tile.dropped)
        put(number);
      if (!tile.dropped.empty())
        put(tile.first_dropped);
    }
    const uint64_t size = bytes.size() + sizeof size;
    std::memcpy(bytes.data() + 16, &size, sizeof size);
    put(lancer::checksum(bytes.data(), bytes.size()));
    return bytes;
  }
};

// A session that joins made parts.
struct MadeJoiner : Owned {
  explicit MadeJoiner(const lancer_settings &settings = made_settings())
      : Owned(0, settings, make_camera(kMadeWidth, kMadeHeight)) {}
};

} // namespace lancer_test
