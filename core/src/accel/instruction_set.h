// Which copy of the kernels runs.
#pragma once

namespace lancer {

enum class InstructionSet { Generic, Sse4, Avx2, Avx512 };

// The best one that this processor runs, or the lesser one that the environment's LANCER_ISA asks for.
InstructionSet instruction_set();

} // namespace lancer
