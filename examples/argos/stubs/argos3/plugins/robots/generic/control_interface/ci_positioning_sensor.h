// Declarations of what the controller calls, for compiling where ARGoS is absent. ARGoS' own header has the same.
#pragma once
#include <argos3/core/utility/math/angles.h>
namespace argos {
class CVector3 {
public:
    Real GetX() const;
    Real GetY() const;
};
class CQuaternion {
public:
    void ToEulerAngles(CRadians& z, CRadians& y, CRadians& x) const;
};
class CCI_PositioningSensor {
public:
    struct SReading {
        CVector3 Position;
        CQuaternion Orientation;
    };
    const SReading& GetReading() const;
};
}
