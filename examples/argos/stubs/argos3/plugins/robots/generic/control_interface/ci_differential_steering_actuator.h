// Declarations of what the controller calls, for compiling where ARGoS is absent. ARGoS' own header has the same.
#pragma once
#include <argos3/core/utility/datatypes/datatypes.h>
namespace argos {
class CCI_DifferentialSteeringActuator {
public:
    virtual ~CCI_DifferentialSteeringActuator() {}
    virtual void SetLinearVelocity(Real left, Real right) = 0;
};
}
