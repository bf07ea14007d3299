/* The SPI of the stand-in: names and signatures of ArduinoCore-API (api/HardwareSPI.h). */
#ifndef ARDUINO_STAND_IN_SPI_H
#define ARDUINO_STAND_IN_SPI_H

#include "Arduino.h"

#define SPI_HAS_TRANSACTION

namespace arduino
{

typedef enum { SPI_MODE0 = 0, SPI_MODE1 = 1, SPI_MODE2 = 2, SPI_MODE3 = 3 } SPIMode;

class SPISettings
{
  public:
    SPISettings(uint32_t clock, BitOrder order, SPIMode mode) : clock_(clock), order_(order), mode_(mode)
    {
    }
    SPISettings() : clock_(4000000), order_(MSBFIRST), mode_(SPI_MODE0)
    {
    }

    uint32_t getClockFreq() const
    {
        return clock_;
    }
    SPIMode getDataMode() const
    {
        return mode_;
    }
    BitOrder getBitOrder() const
    {
        return order_;
    }

  private:
    uint32_t clock_;
    BitOrder order_;
    SPIMode mode_;
};

class HardwareSPI
{
  public:
    virtual ~HardwareSPI()
    {
    }
    virtual uint8_t transfer(uint8_t data) = 0;
    virtual uint16_t transfer16(uint16_t data) = 0;
    virtual void transfer(void *buf, size_t count) = 0;
    virtual void usingInterrupt(int interruptNumber) = 0;
    virtual void notUsingInterrupt(int interruptNumber) = 0;
    virtual void beginTransaction(SPISettings settings) = 0;
    virtual void endTransaction(void) = 0;
    virtual void attachInterrupt() = 0;
    virtual void detachInterrupt() = 0;
    virtual void begin() = 0;
    virtual void end() = 0;
};

typedef HardwareSPI SPIClass;

} // namespace arduino

extern SPIClass &SPI;

#endif
