"""Gambol's controllers: arrays in, arrays out; no window, no GL, no clock."""
