// Declarations of what the controller calls, for compiling where ARGoS is absent. ARGoS' own header has the same.
#pragma once
#include <argos3/core/utility/datatypes/byte_array.h>
namespace argos {
class CCI_RangeAndBearingActuator {
public:
    void SetData(const CByteArray& data);
};
}
