// Declarations of what the controller calls, for compiling where ARGoS is absent. ARGoS' own header has the same.
#pragma once
#include <argos3/core/utility/datatypes/datatypes.h>
namespace argos {
class CVector2 {
public:
    Real GetX() const;
    Real GetY() const;
};
}
