// Runs every file of the given folders once: the fuzzer's findings stay tested, with any compiler.
#include "program.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

int main(int count, char **folders) {
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < count; ++i)
    for (const auto &entry : std::filesystem::directory_iterator(folders[i]))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path &path : files) {
    // Print the name first: the last one is the file that fails.
    std::printf("%s\n", path.filename().string().c_str());
    std::fflush(stdout);
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    lancer_fuzz::run_program(reinterpret_cast<const uint8_t *>(bytes.data()), bytes.size());
  }
  // An empty folder tests nothing.
  return files.empty();
}
