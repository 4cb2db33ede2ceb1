// Declarations of what the controller calls, for compiling where ARGoS is absent. ARGoS' own header has the same.
#pragma once
#include <sstream>
#include <stdexcept>
#include <string>
namespace argos {
class CARGoSException : public std::exception {
public:
    explicit CARGoSException(const std::string& message);
};
}
#define THROW_ARGOSEXCEPTION(message) \
    { \
        std::ostringstream stream; \
        stream << message; \
        throw ::argos::CARGoSException(stream.str()); \
    }
