// The same program in C++.
#include "first.c"
