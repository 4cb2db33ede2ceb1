// Declarations of what the controller calls, for compiling where ARGoS is absent. ARGoS' own header has the same.
#pragma once
#include <argos3/core/utility/math/angles.h>
#include <vector>
namespace argos {
class CCI_EPuck2ProximitySensor {
public:
    struct SReading {
        SInt32 Value;
        CRadians Angle;
    };
    typedef std::vector<SReading> TReadings;
    const TReadings& GetReadings() const;
};
}
