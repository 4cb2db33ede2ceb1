// Declarations of what the controller calls, for compiling where ARGoS is absent. ARGoS' own header has the same.
#pragma once
#include <argos3/core/utility/datatypes/datatypes.h>
#include <string>
namespace argos {
class TConfigurationNode;
template <typename T> void GetNodeAttribute(TConfigurationNode& node, const std::string& name, T& value);
template <typename T>
void GetNodeAttributeOrDefault(TConfigurationNode& node, const std::string& name, T& value, const T& otherwise);
class CCI_Controller {
public:
    virtual ~CCI_Controller() {}
    virtual void Init(TConfigurationNode&) {}
    virtual void ControlStep() {}
    virtual void Reset() {}
protected:
    template <typename T> T* GetSensor(const std::string& name);
    template <typename T> T* GetActuator(const std::string& name);
};
}
#define REGISTER_CONTROLLER(CLASS, LABEL) \
    argos::CCI_Controller* Make##CLASS(); \
    argos::CCI_Controller* Make##CLASS() { return new CLASS; }
