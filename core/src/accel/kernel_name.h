// Kernels are compiled once per instruction set, with LANCER_ISA naming it; the name as text.
#pragma once

#ifndef LANCER_ISA
#define LANCER_ISA generic
#endif
#define LANCER_TEXT(x) #x
#define LANCER_TEXT_OF(x) LANCER_TEXT(x)
#define LANCER_ISA_NAME LANCER_TEXT_OF(LANCER_ISA)
