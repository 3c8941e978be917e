// Which copy of the kernels runs.
#pragma once

namespace lancer {

enum class InstructionSet { Scalar, Generic, Sse4, Avx2, Avx512 };

// The best one that this processor runs, or the lesser one that the environment's LANCER_ISA asks for.
// Scalar: of shading a copy of one lane, in which a fault is easier to follow; of the rest the least one.
InstructionSet instruction_set();

} // namespace lancer
