// Declarations of what the controller calls, for compiling where ARGoS is absent. ARGoS' own header has the same.
#pragma once
#include <argos3/core/utility/datatypes/datatypes.h>
#include <cstddef>
namespace argos {
class CByteArray {
public:
    CByteArray(std::size_t size, UInt8 value = 0);
    std::size_t Size() const;
    UInt8& operator[](std::size_t index);
    UInt8 operator[](std::size_t index) const;
};
}
