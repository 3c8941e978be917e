// The film: tiles of double sums that do not depend on the order in which threads add samples.
#pragma once

#include "integrator/sample.h"
#include "lancer.h"
#include "render/matte_sums.h"
#include "sampling/sobol.h"

#include <array>
#include <mutex>

namespace lancer {

inline constexpr uint32_t kPassCount = LANCER_PASS_COUNT;

uint32_t channels(Pass pass);
// Returns how many channels a film keeps of a pass. After the vectors comes their weight, by which their sum is divided.
uint32_t kept_channels(Pass pass);
// Whether the pass stores the value of sample 0 alone: a mean of depths or indices would belong to no object.
bool of_first_sample(Pass pass);
// Returns the colour that a direct or indirect pass is divided by, or the pass itself if there is none.
Pass divisor(Pass pass);
// Returns the pass whose halves a pass of halves compares, or the pass itself.
Pass halved(Pass pass);
// Returns the passes that the film sums for the requested ones: with Combined, divisors and halved passes.
uint32_t kept_passes(uint32_t passes);

// Returns the index of a pass's first channel among the floats of a sample.
uint32_t place_in_sample(Pass pass);

// Divides light by its colour. A channel without colour gets the mean of the other channels that have colour; without any
// colour, the quotient is 0.
glm::dvec3 divide_by_color(const glm::dvec3 &light, const glm::dvec3 &color);

// The samples of a pixel are summed along one fixed binary tree over their numbers: sample s is a leaf, and two neighbouring
// complete subtrees of equal size are always joined. Only the sums that wait for their neighbour are stored: while samples
// arrive in order, one per bit of the count, as in a binary counter. So the bits depend neither on threads, nor on tiles, nor
// on the division of the range, and another machine can compute any subtree: insert() adds it.
//
// Beside the sum of a subtree, the film stores the difference of the luminances of its two halves, from which the error of the
// picture is estimated. All samples of a pixel are points of one sequence. For its first N = 2^k points, let V(N) be the
// variance of their mean, and A and B the means of the two halves. Then U(N) = E (A - B)^2 / 4 = V(N / 2) - V(N), because each
// half is scrambled like the whole. U equals V where the variance falls as 1 / N, and exceeds V where the variance falls
// faster. On twenty scenes, sqrt(U) is mostly 1.00 to 1.10 times the real standard error, and up to 1.8 times where points
// first become even at 64 samples.
class Film {
public:
  // The pixels that belong to a tile: all of its rectangle, or those of one colour of a chessboard.
  enum class Cells : uint32_t { All, Even, Odd };

  // passes: bits 1u << Pass; Combined is always stored, and each light pass is stored together with the colour by which it is
  // divided. halves: every square becomes two tiles of a chessboard; tile 2 i + 1 is the other half of tile 2 i.
  // extras: the channels and the mattes that it sums beside the passes.
  Film(uint32_t width, uint32_t height, uint32_t tile_size, uint32_t passes, bool halves = false,
       const ExtraLayout &extras = {});

  // Returns the memory, in bytes, of a film of this size where that number of sums waits in each pixel.
  static double bytes_needed(double width, double height, uint32_t passes, uint32_t sums, const ExtraLayout &extras = {});

  // A complete subtree: [pixel][summed channel]; [pixel] the difference of its halves' mean luminances, 0 for a leaf; for
  // passes of halves the same of their mean colours, [pixel][channel]; the mattes of each kind.
  struct Sums {
    std::vector<double> channels;
    std::vector<float> differences, color_differences;
    std::array<MatteSums, kMatteKinds> mattes;
  };

  // The subtree of the samples start ... start + 2^level - 1.
  struct Node {
    uint32_t start = 0, level = 0;
    Sums sums;

    uint64_t end() const { return start + (uint64_t(1) << level); }
  };

  struct Tile {
    uint32_t x, y, width, height;
    Cells cells = Cells::All;
    uint32_t count = 0;            // samples of each of its pixels
    uint32_t first_sample = 0;     // the one that add() gives to an empty tile
    std::vector<Node> nodes;       // by start; no two of them can be joined
    std::vector<float> first;      // [pixel][channel of sample 0]
    std::vector<float> brightest;  // [pixel] largest luminance of a sample, by its absolute value
    std::vector<uint64_t> dropped; // by the bit width of the sample's number; empty where none was dropped
    SampleAddress first_dropped{0, 0, 0};
    double seconds = 0.0; // of the threads that rendered its samples here
    mutable std::mutex mutex;

    uint32_t pixels() const;
    glm::uvec2 place(uint32_t pixel) const;
    // Returns the number of the sample that add() adds next.
    uint32_t next() const { return nodes.empty() ? first_sample : uint32_t(nodes.back().end()); }
    // Whether the samples are 0 ... count - 1.
    bool whole() const { return count == 0 || next() == count; }
  };

  size_t tile_count() const { return tiles_.size(); }
  Tile &tile(size_t i) { return *tiles_[i]; }
  const Tile &tile(size_t i) const { return *tiles_[i]; }
  bool halves() const { return halves_; }

  // Adds the next samples of all pixels of a tile: results[s][pixel] in order of sample. If memory runs out, the tile keeps the
  // samples counted so far. extras: of the results, where the film keeps any.
  void add(Tile &tile, uint32_t samples, std::span<const SampleResult> results, const Extras &extras = {});
  // Adds the next samples where they are equal in all pixels and have no mattes.
  void add_even(Tile &tile, uint32_t samples, const SampleResult &result, const Extras &extras = {});
  // Adds a subtree of samples that the tile does not have, and joins all neighbours. Throws nothing if tile.nodes has room
  // and the film keeps no mattes.
  void insert(Tile &tile, Node &&node) const;
  // Empties a tile, whose next sample is then first_sample.
  static void clear(Tile &tile, uint32_t first_sample);
  // Counts a sample that is dropped because it is not finite. Must be called before the samples of its batch are added. Calls
  // must be in order of sample and pixel.
  void drop(Tile &tile, const SampleAddress &address);
  struct Dropped {
    uint64_t samples = 0;
    SampleAddress first{0, 0, 0}; // the lowest number of a sample, and among equal ones the lowest row
  };
  // Returns the number of dropped samples and the first of them, among the samples that the film contains.
  Dropped dropped() const;
  // Forgets the samples beyond the last power of two, unless some before them are missing.
  void round_down(Tile &tile);
  // Returns the least and the largest number of samples of a pixel.
  std::pair<uint32_t, uint32_t> sample_range() const;
  // Statistics of a pixel's luminance. variance: of the mean; for a power-of-two count it has one degree of freedom.
  struct Luminance {
    double mean, variance, brightest;
  };
  // The fewest samples of a pixel from which an error can be estimated.
  static constexpr uint32_t kLeastSamples = 2;
  // out: one record for each pixel of the tile. Returns the tile's number of samples per pixel; 0, and leaves out unset, if the
  // tile is not whole or has less than kLeastSamples.
  uint32_t luminances(const Tile &tile, std::span<Luminance> out) const;
  // Whether all summed channels are finite; extras: those of the sample, or null where the film keeps none.
  bool finite(const SampleResult &result, const float *extras = nullptr) const;
  // Write [height][width][channels], row 0 at the bottom; a pixel without samples is 0, and its depth 1e10.
  void read(Pass pass, std::span<float> out) const;
  // Passes without a bit, see lancer_pass_kind. extra: the first of count channels of ExtraLayout.
  void read_extra(uint32_t extra, uint32_t count, std::span<float> out) const;
  void read_mattes(uint32_t kind, uint32_t number, std::span<float> out) const;
  void read_catcher(std::span<float> out) const;
  // Writes Combined where shadow catchers leave only their shadows; over_environment: the film is not transparent.
  void read_shadows(bool over_environment, std::span<float> out) const;
  void read_sample_count(std::span<float> out) const;
  void read_render_time(std::span<float> out) const;
  bool has(Pass pass) const { return (passes_ & bit(pass)) != 0; }
  size_t bytes() const;
  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  uint32_t passes() const { return passes_; }
  const ExtraLayout &extras() const { return layout_.extras; }
  // Numbers of a pixel: in the sums of a node, in its differences of colours, and of sample 0.
  struct Channels {
    uint32_t summed, differences, first;
  };
  Channels channels_of_pixel() const { return {layout_.summed_channels, layout_.difference_channels, layout_.first_channels}; }

private:
  // The channels that are stored, in order of pass.
  struct Layout {
    Layout(uint32_t passes, const ExtraLayout &extras);

    // Consecutive channels, both in a sample and in the film.
    struct Run {
      uint32_t from, to, count;
    };
    static void add(std::vector<Run> &runs, Pass pass, uint32_t to);

    std::vector<Run> summed, first;
    std::vector<Pass> halves;
    std::array<uint32_t, kPassCount> at{}; // first channel of a pass in its list
    uint32_t summed_channels = 0, first_channels = 0, difference_channels = 0;
    ExtraLayout extras;       // its channels are the last of the summed ones
    uint32_t first_extra = 0; // of the summed channels
  };

  void keep_first(Tile &tile, std::span<const SampleResult> results) const;
  // Inserts a node into a tile whose mutex is locked.
  void insert_locked(Tile &tile, Node &&node) const;
  void gather(std::span<const SampleResult> results, const float *extras, Sums &sums, float *brightest) const;
  void gather_mattes(const MattesBySample &mattes, size_t first, uint32_t pixels, Sums &sums) const;
  // Adds the mattes of the earlier half of a subtree; allocates.
  void join_mattes(const Node &earlier, Sums &later) const;
  // Calls write(tile, pixel, target) for each pixel that has samples; others are 0.
  template <class Write> void read_each(uint32_t width, std::span<float> out, Write &&write) const;
  // Return the sum and the mean of a pixel's summed channel, joined along the tree.
  static double sum_of(const Tile &tile, size_t place);
  static double mean_of(const Tile &tile, size_t place) { return sum_of(tile, place) / double(tile.count); }
  glm::dvec4 matte_of(const Tile &tile, uint32_t pixel) const;
  // Returns the pass SHADOW_CATCHER of a pixel.
  glm::dvec3 catcher_of(const Tile &tile, uint32_t pixel) const;
  void keep_differences(const Sums &earlier, uint32_t level, Sums &later) const;
  glm::dvec3 mean_color(Pass pass, const Sums &sums, uint32_t level, uint32_t pixel) const;
  double mean_luminance(const Sums &sums, uint32_t level, uint32_t pixel) const;
  // Joins the waiting sums of a pixel that has at least two samples, larger ones first. mean_of(sums, level): the mean of a
  // sum; difference_of(sums): the difference of its halves; part(share, apart): receives half of that, with the sum's share of
  // the samples. Returns the mean of all.
  template <class Value, class MeanOf, class DifferenceOf, class Part>
  static Value join_halves(const Tile &tile, MeanOf &&mean_of, DifferenceOf &&difference_of, Part &&part);
  void read_halves(Pass pass, const Tile &tile, uint32_t pixel, float *target) const;
  void read_means(Pass pass, const Tile &tile, uint32_t pixel, float *target) const;

  uint32_t width_, height_, passes_;
  bool halves_;
  Layout layout_;
  std::vector<std::unique_ptr<Tile>> tiles_;
};

} // namespace lancer
