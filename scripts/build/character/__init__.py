"""How the mannequin is made: its shape, its mesh and the binding to its joints."""
