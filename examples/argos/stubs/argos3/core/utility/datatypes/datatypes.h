// Declarations of what the controller calls, for compiling where ARGoS is absent. ARGoS' own header has the same.
#pragma once
#include <cstdint>
namespace argos {
typedef double Real;
typedef std::uint8_t UInt8;
typedef std::int32_t SInt32;
typedef std::uint32_t UInt32;
}
