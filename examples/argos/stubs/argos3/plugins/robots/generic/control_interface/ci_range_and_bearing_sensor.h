// Declarations of what the controller calls, for compiling where ARGoS is absent. ARGoS' own header has the same.
#pragma once
#include <argos3/core/utility/datatypes/byte_array.h>
#include <vector>
namespace argos {
class CCI_RangeAndBearingSensor {
public:
    struct SPacket {
        Real Range;
        CByteArray Data;
    };
    const std::vector<SPacket>& GetReadings() const;
};
}
