// Random123 asks for a processor that it knows. Its integers are the same on this one.
#pragma once

#define __riscv
#include_next <Random123/philox.h>
#undef __riscv
