// Runs every file of the named folders once: what fuzzing has found stays tested, with any compiler.
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
    // Said first: the last name is that of the file which does not end well.
    std::printf("%s\n", path.filename().string().c_str());
    std::fflush(stdout);
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    lancer_fuzz::run_program(reinterpret_cast<const uint8_t *>(bytes.data()), bytes.size());
  }
  // An empty folder tests nothing.
  return files.empty();
}
