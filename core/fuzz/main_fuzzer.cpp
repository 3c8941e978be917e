// Runs the program under libFuzzer.
#include "program.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  lancer_fuzz::run_program(data, size);
  return 0;
}
